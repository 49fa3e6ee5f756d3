// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Scenes and directions for the tests of rays.
#pragma once

#include <cmath>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include "libscan/core/random.h"
#include "synth/scene.h"

namespace scan::synth {

inline Eigen::Vector3d random_vector(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

inline Scene scene_of(std::vector<std::variant<Shape, Mesh>> geometries,
                      const Pose& pose = Pose::Identity()) {
  Scene scene;
  scene.materials.push_back({});
  for (auto& geometry : geometries) scene.objects.push_back({"", pose, std::move(geometry), 0});
  return scene;
}

inline Pose at(double x, double y, double z) {
  return make_pose(Eigen::Matrix3d::Identity(), {x, y, z});
}

// A closed sphere-like mesh with bumps; coordinates are whole multiples of 2^-24 m, so that offsets
// of up to 1e7 m change no bit of its shape.
inline Mesh bumpy_ball(int rings, int sectors) {
  Mesh mesh;
  const auto place = [&](double polar, double azimuth) {
    const double r = 1 + 0.1 * std::sin(4 * polar) * std::cos(3 * azimuth) * std::sin(polar);
    const Eigen::Vector3d x(r * std::sin(polar) * std::cos(azimuth),
                            r * std::sin(polar) * std::sin(azimuth), r * std::cos(polar));
    mesh.vertices.push_back((x * 0x1p24).array().round() * 0x1p-24);
  };
  place(0, 0);
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < sectors; ++j)
      place(std::numbers::pi * i / rings, 2 * std::numbers::pi * j / sectors);
  place(std::numbers::pi, 0);
  const auto at_ring = [&](int i, int j) {
    return static_cast<std::uint32_t>(1 + (i - 1) * sectors + j % sectors);
  };
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (int j = 0; j < sectors; ++j) {
    mesh.triangles.push_back({0, at_ring(1, j), at_ring(1, j + 1)});
    for (int i = 1; i + 1 < rings; ++i) {
      mesh.triangles.push_back({at_ring(i, j), at_ring(i + 1, j), at_ring(i, j + 1)});
      mesh.triangles.push_back({at_ring(i, j + 1), at_ring(i + 1, j), at_ring(i + 1, j + 1)});
    }
    mesh.triangles.push_back({at_ring(rings - 1, j + 1), at_ring(rings - 1, j), last});
  }
  return mesh;
}

}  // namespace scan::synth
