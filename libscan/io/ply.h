// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// PLY, the core format: ascii and binary of both byte orders, any element and property kept, double
// precision exact (Turk 1994; 17 significant digits in ascii, or the shortest that read back).
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "libscan/core/mesh.h"
#include "libscan/core/point_cloud.h"

namespace scan {

// A file as it stands: elements with scalar or list properties, and comments. Scalars are kept in the
// file's own type.
struct PlyProperty {
  std::string name;
  using Values = std::variant<std::vector<std::int8_t>, std::vector<std::uint8_t>,
                              std::vector<std::int16_t>, std::vector<std::uint16_t>,
                              std::vector<std::int32_t>, std::vector<std::uint32_t>,
                              std::vector<float>, std::vector<double>>;
  Values values;                        // all entries in a row
  std::vector<std::uint32_t> lengths;   // list property: entries of each row; empty: scalar property
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
  std::vector<PlyElement> elements;
  const PlyElement* find(std::string_view element) const;
};

enum class PlyEncoding { ascii, binary_little_endian, binary_big_endian };

// scan::Error (input) names file, element, property and row for anything broken. Memory is bounded
// by the file's size: a header that claims more rows than the file can hold is refused before any
// allocation.
Ply read_ply(const std::filesystem::path& path);

// Written whole or not at all.
void write_ply(const std::filesystem::path& path, const Ply& ply,
               PlyEncoding encoding = PlyEncoding::binary_little_endian);

// Views on the well-known elements. `mesh_from` triangulates polygons as fans. Missing x, y or z is
// scan::Error (input) naming `path`.
PointCloud cloud_from(const Ply& ply, const std::filesystem::path& path);
Mesh mesh_from(const Ply& ply, const std::filesystem::path& path);
Ply ply_from(const PointCloud& cloud);
Ply ply_from(const Mesh& mesh);

}  // namespace scan
