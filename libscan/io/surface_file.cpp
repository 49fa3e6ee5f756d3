// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/surface_file.h"

#include "libscan/io/ply.h"
#include "libscan/io/scan_file.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

bool is_ply(const std::filesystem::path& path) {
  return lower_case(path.extension().string()) == ".ply";
}

void add_column(Ply& ply, const char* name, const std::vector<double>& values) {
  if (!values.empty()) ply.elements.front().properties.push_back({name, values, {}, false});
}

}  // namespace

void write_supported_mesh(const std::filesystem::path& path, const SupportedMesh& surface) {
  if (!is_ply(path)) return write_mesh(path, surface.mesh);
  Ply ply = ply_from(surface.mesh);  // its first element is the vertex
  add_column(ply, "support_m", surface.support_m);
  add_column(ply, "data_spacing_m", surface.data_spacing_m);
  add_column(ply, "standard_error_m", surface.standard_error_m);
  write_ply(path, ply);
}

SupportedMesh read_supported_mesh(const std::filesystem::path& path) {
  SupportedMesh supported{read_mesh(path), {}, {}, {}};
  if (!is_ply(path)) return supported;
  const Ply ply = read_ply(path);
  const PlyElement* vertex = ply.find("vertex");
  supported.support_m = vertex->numbers("support_m");
  supported.data_spacing_m = vertex->numbers("data_spacing_m");
  supported.standard_error_m = vertex->numbers("standard_error_m");
  return supported;
}

}  // namespace scan
