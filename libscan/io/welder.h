// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Topology for triangles that come as bare corners: equal vertices become one.
#pragma once

#include <functional>
#include <unordered_map>

#include "libscan/core/mesh.h"

namespace scan {

// Numbers vertices in the order of their first use and leaves out triangles that are a line or a
// point.
class Welder {
 public:
  // False for a triangle that is left out.
  bool add(const std::array<Eigen::Vector3d, 3>& corners) {
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = index_of(corners[k]);
    const bool is_line =
        triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
    if (!is_line) mesh_.triangles.push_back(triangle);
    return !is_line;
  }
  Mesh take() { return std::move(mesh_); }

 private:
  struct Hash {
    std::size_t operator()(const Eigen::Vector3d& v) const {
      std::size_t hash = 0;
      for (const double x : v) hash = hash * 0x9E3779B97F4A7C15ull + std::hash<double>()(x);
      return hash ^ (hash >> 29);
    }
  };

  std::uint32_t index_of(const Eigen::Vector3d& vertex) {
    const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto [found, is_new] = indices_.try_emplace(vertex, next);
    if (is_new) mesh_.vertices.push_back(vertex);
    return found->second;
  }

  Mesh mesh_;
  std::unordered_map<Eigen::Vector3d, std::uint32_t, Hash> indices_;
};

}  // namespace scan
