// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A reconstructed surface with what its vertices know of themselves.
#pragma once

#include <filesystem>
#include <vector>

#include "libscan/core/mesh.h"

namespace scan {

// `support_m`: distance of each vertex to the nearest data point; `data_spacing_m`: how far apart
// the data are there; `standard_error_m`: one standard deviation across the surface. Each has one
// entry per vertex or is empty.
struct SupportedMesh {
  Mesh mesh;
  std::vector<double> support_m;
  std::vector<double> data_spacing_m;
  std::vector<double> standard_error_m;
};

// Endings as write_mesh; .ply alone keeps the lists, as properties of their names.
void write_supported_mesh(const std::filesystem::path& path, const SupportedMesh& surface);

// As read_mesh, with the lists where the file has them.
SupportedMesh read_supported_mesh(const std::filesystem::path& path);

}  // namespace scan
