// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Views of one object from all sides, with known poses.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/align/test_shapes.h"

namespace scan::test {

struct Turntable {
  std::vector<PointCloud> clouds;
  std::vector<Pose> truth, guesses;
};

// `count` views around z, each of the half that faces it, with points of its own, so many all
// round.
inline Turntable turntable(int count, double sigma_m, std::size_t points = 12000) {
  Turntable t;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    PointCloud all = lump(points, 100 + std::uint64_t(i));
    const Vector3d view(std::cos(angle), std::sin(angle), 0.3);
    std::vector<std::uint32_t> seen;
    for (std::uint32_t k = 0; k < all.size(); ++k)
      if (all.normals[k].dot(view) > 0.1) seen.push_back(k);
    PointCloud cloud = subset(all, seen);
    add_noise(cloud, sigma_m, 200 + std::uint64_t(i));
    RandomStream random(300 + std::uint64_t(i), 0, 0);
    const Pose pose = random_pose(random, 2, 3);
    t.truth.push_back(pose);
    t.clouds.push_back(transformed(pose.inverse(), cloud));
    t.guesses.push_back(i == 0 ? pose : random_pose(random, 0.05, 0.04) * pose);
  }
  return t;
}

}  // namespace scan::test
