// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Other programs' surface distances, each with its own samples and its own search.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "libscan/core/mesh.h"

namespace scan {

// Two meshes, also as files.
struct MetricsCase {
  const char* name;
  Mesh measured, truth;
  std::filesystem::path measured_file, truth_file;
};

// Unsigned distances of `count` points, drawn by CloudCompare on the measured mesh, from the truth.
// None where the program is not there.
std::optional<std::vector<double>> cloudcompare_distances_m(const MetricsCase& of,
                                                            std::size_t count);

// The two-sided Hausdorff distance by CGAL, right to `bound_m`.
double cgal_hausdorff_m(const MetricsCase& of, double bound_m);

}  // namespace scan
