// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/winding_number.h"

#include <gtest/gtest.h>

#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

// Samples drawn at random, N in all, each known to some third of its own area (10 neighbours): the
// integral has a deviation of about 1 / sqrt(N) in the middle, 0.014, and a bias of their areas'
// median below 0.07. Twice the sum of both.
constexpr double near = 0.17;

Eigen::Vector3d unit(const Samples& samples, const Eigen::Vector3d& x) {
  return samples.box.to_unit(x);
}

TEST(WindingNumber, IsOneInsideAClosedSurfaceAndNoneOutside) {
  const Samples samples = prepare_samples(torus_cloud(5000));
  const WindingNumber winding(samples);
  EXPECT_NEAR(winding.at(unit(samples, {1, 0, 0})), 1, near);
  EXPECT_NEAR(winding.at(unit(samples, {0, -1, 0.1})), 1, near);
  EXPECT_NEAR(winding.at(unit(samples, {0, 0, 0})), 0, near);
  EXPECT_NEAR(winding.at(unit(samples, {1, 0, 0.6})), 0, near);
  EXPECT_NEAR(winding.on_surface(), 0.5, near);
}

// The cap beyond 60 degrees from the pole takes a quarter of the directions: (1 - cos 60) / 2.
TEST(WindingNumber, LosesTheDirectionsThroughAHole) {
  const PointCloud whole = sphere_cloud(5000);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < whole.size(); ++i)
    if (whole.points[i][2] < 0.5) kept.push_back(i);
  const Samples samples = prepare_samples(subset(whole, kept));
  EXPECT_NEAR(WindingNumber(samples).at(unit(samples, {0, 0, 0})), 0.75, 0.75 * near);
}

TEST(WindingNumber, IsNoneOnAPlaneSheet) {
  PointCloud sheet;
  RandomStream random(5, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(), y = random.uniform();
    sheet.points.push_back({x, y, 0});
    sheet.normals.push_back(Eigen::Vector3d::UnitZ());
  }
  const Samples samples = prepare_samples(sheet);
  const WindingNumber winding(samples);
  EXPECT_NEAR(winding.on_surface(), 0, 1e-9);
  EXPECT_LT(winding.at(unit(samples, {0.5, 0.5, 0.1})), -0.25);
  EXPECT_GT(winding.at(unit(samples, {0.5, 0.5, -0.1})), 0.25);
}

}  // namespace
}  // namespace scan
