// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// PLY, the core format: ascii and binary of both byte orders, any element and property kept, double
// precision exact (Turk 1994; 17 significant digits in ascii, or the shortest that read back).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "libscan/core/mesh.h"
#include "libscan/core/point_cloud.h"

namespace scan {

// A file as it stands: elements with scalar or list properties, and comments. Scalars are kept in
// the file's own type.
struct PlyProperty {
  std::string name;
  using Values =
      std::variant<std::vector<std::int8_t>, std::vector<std::uint8_t>, std::vector<std::int16_t>,
                   std::vector<std::uint16_t>, std::vector<std::int32_t>,
                   std::vector<std::uint32_t>, std::vector<float>, std::vector<double>>;
  Values values;                       // all entries in a row
  std::vector<std::uint32_t> lengths;  // list property: entries of each row; empty: scalar property
  bool is_list = false;
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
  const PlyProperty* find(std::string_view property) const;
  std::vector<double> numbers(std::string_view property) const;  // of a scalar; empty if absent
};

struct Ply {
  std::vector<std::string> comments;
  std::vector<std::string> obj_info;  // `obj_info` lines: what Stanford's scanner software noted
  std::vector<PlyElement> elements;
  const PlyElement* find(std::string_view element) const;
};

enum class PlyEncoding { ascii, binary_little_endian, binary_big_endian };

// scan::Error (input) names file, element, property and row (from 0) for anything broken. Memory is
// bounded by the file's size: a header that claims more rows than the file can hold is refused
// before any allocation. Header lines may end in \n, \r\n or \r.
Ply read_ply(const std::filesystem::path& path);
// The same from memory; `name` is how errors call it.
Ply parse_ply(std::string_view content, const std::string& name);

// Written whole or not at all. scan::Error (input) if properties differ in length or a name or
// comment would break the header.
std::string ply_bytes(const Ply& ply, PlyEncoding encoding = PlyEncoding::binary_little_endian);
void write_ply(const std::filesystem::path& path, const Ply& ply,
               PlyEncoding encoding = PlyEncoding::binary_little_endian);

// Views on the well-known elements: `vertex` with x y z, nx ny nz, sigma_m, cov_xx cov_xy cov_xz
// cov_yy cov_yz cov_zz and intensity (or scalar_intensity), `face` with vertex_indices (or
// vertex_index). `mesh_from` triangulates polygons as fans. Missing x, y or z is scan::Error
// (input) naming `path`, and so is a face that names a vertex which is not there.
PointCloud cloud_from(const Ply& ply, const std::filesystem::path& path);
Mesh mesh_from(const Ply& ply, const std::filesystem::path& path);
Ply ply_from(const PointCloud& cloud);
Ply ply_from(const Mesh& mesh);

}  // namespace scan
