// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far a surface is from the data, and which of its parts data supports.
#pragma once

#include <span>

#include "libscan/core/mesh.h"

namespace scan {

// Distance of each vertex to the nearest point.
std::vector<double> distance_to_points(const Mesh& mesh, std::span<const Eigen::Vector3d> points);

// At each vertex what `values` holds for the point nearest to it.
std::vector<double> of_nearest_points(const Mesh& mesh, std::span<const Eigen::Vector3d> points,
                                      std::span<const double> values);

// Component of each triangle (connected by shared vertices), numbered by first appearance.
std::vector<std::uint32_t> triangle_components(const Mesh& mesh);

// The triangles that are kept and the vertices they use, both in their old order; of a quad both
// halves or none. `vertex_of` gets the old index of each vertex.
Mesh kept_triangles(const Mesh& mesh, std::vector<char> keep,
                    std::vector<std::uint32_t>& vertex_of);

// Without the components that are nearest to less than `least_share` of the points' weight.
Mesh supported_components(const Mesh& mesh, std::span<const Eigen::Vector3d> points,
                          std::span<const double> weights, double least_share);

// Turns each triangle to begin with its lowest vertex and sorts them: for programs whose order of
// triangles follows addresses in memory.
void sort_triangles(Mesh& mesh);

}  // namespace scan
