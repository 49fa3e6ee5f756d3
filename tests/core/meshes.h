// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Small meshes whose area, volume and topology are known.
#pragma once

#include <cmath>
#include <numbers>

#include "libscan/core/mesh.h"
#include "libscan/core/random.h"

namespace scan {

// Corners at the origin and at 1 on each axis: volume 1/6, area 3/2 + sqrt(3)/2.
inline Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

// From the origin to (size, size, size), 12 triangles.
inline Mesh cube(double size) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(size * Eigen::Vector3d(i & 1, i >> 1 & 1, i >> 2));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// A grid around the z axis with the given numbers of steps; genus 1.
inline Mesh torus(double major, double minor, std::uint32_t around, std::uint32_t across) {
  Mesh mesh;
  const double turn = 2 * std::numbers::pi;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t k = 0; k < across; ++k) {
      const double u = turn * i / around, v = turn * k / across;
      const double radius = major + minor * std::cos(v);
      mesh.vertices.push_back({radius * std::cos(u), radius * std::sin(u), minor * std::sin(v)});
    }
  const auto id = [&](std::uint32_t i, std::uint32_t k) {
    return (i % around) * across + k % across;
  };
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t k = 0; k < across; ++k) {
      mesh.triangles.push_back({id(i, k), id(i + 1, k), id(i + 1, k + 1)});
      mesh.triangles.push_back({id(i, k), id(i + 1, k + 1), id(i, k + 1)});
    }
  return mesh;
}

// Each vertex off by normal noise per axis.
inline Mesh shaken(Mesh mesh, double sigma_m) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    RandomStream random(1, 0, i);
    const double x = random.normal(), y = random.normal(), z = random.normal();
    mesh.vertices[i] += sigma_m * Eigen::Vector3d(x, y, z);
  }
  return mesh;
}

}  // namespace scan
