// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/sampling/warp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "libscan/core/random.h"
#include "tests/synth/goodness.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

struct Warp {
  std::string name;
  std::function<Eigen::Vector3d(const Eigen::Vector2d&)> map;
  std::function<double(const Eigen::Vector3d&)> density;
};

std::vector<Warp> warps() {
  std::vector<Warp> all = {
      {"sphere", to_sphere, [](const Eigen::Vector3d&) { return sphere_density(); }},
      {"hemisphere", to_hemisphere, hemisphere_density},
      {"cosine", to_cosine_hemisphere, cosine_hemisphere_density}};
  for (const double alpha : {0.15, 0.5, 1.0}) {
    all.push_back({"beckmann " + std::to_string(alpha),
                   [=](const Eigen::Vector2d& u) { return to_beckmann_normal(u, alpha); },
                   [=](const Eigen::Vector3d& h) { return beckmann_normal_density(h, alpha); }});
    for (const double cosine : {1.0, 0.6, 0.1}) {
      const Eigen::Vector3d out = direction_at(cosine, 0.7);
      all.push_back(
          {"ggx " + std::to_string(alpha) + " from " + std::to_string(cosine),
           [=](const Eigen::Vector2d& u) { return to_ggx_visible_normal(u, out, alpha); },
           [=](const Eigen::Vector3d& h) { return ggx_visible_normal_density(h, out, alpha); }});
    }
  }
  return all;
}

TEST(Warp, DensitiesIntegrateToOne) {
  const SphereCells cells;
  for (const Warp& warp : warps()) {
    // smooth within a cell but for max(0, out.h), whose kink 24 nodes resolve to 1 / 24^2
    const double tolerance = warp.name.starts_with("ggx") ? 1.0 / 576 : 1e-9;
    EXPECT_NEAR(total(cells.integrals(warp.density)), 1, tolerance) << warp.name;
  }
}

TEST(Warp, SamplesFollowTheirDensities) {
  const SphereCells cells;
  const int draws = 100000;
  for (const Warp& warp : warps()) {
    RandomStream random(7, 0, 0);
    std::vector<double> counts(cells.count(), 0.0);
    for (int i = 0; i < draws; ++i) {
      const double u = random.uniform(), v = random.uniform();
      const Eigen::Vector3d drawn = warp.map({u, v});
      ASSERT_NEAR(drawn.norm(), 1, 1e-12) << warp.name;
      ++counts[cells.index(drawn)];
    }
    std::vector<double> expected = cells.integrals(warp.density);
    for (double& share : expected) share *= draws;
    // fifteen tests, a false alarm in one of a thousand seeds
    EXPECT_GT(goodness_of_fit(counts, expected), 1e-3 / 15) << warp.name;
  }
}

TEST(Warp, DiskIsUniformAndKeepsNeighboursTogether) {
  RandomStream random(8, 0, 0);
  const int rings = 8, sectors = 16, draws = 100000;
  std::vector<double> counts(rings * sectors, 0.0);
  for (int i = 0; i < draws; ++i) {
    const double u = random.uniform(), v = random.uniform();
    const Eigen::Vector2d p = to_disk({u, v});
    ASSERT_LE(p.norm(), 1 + 1e-15);
    EXPECT_EQ(disk_density(p * 0.999), 1 / pi);
    const double turn = std::atan2(p.y(), p.x()) / (2 * pi) + 0.5;
    const int ring = std::min(static_cast<int>(p.squaredNorm() * rings), rings - 1);
    ++counts[ring * sectors + static_cast<int>(turn * sectors) % sectors];
    // concentric: the square of half the side lands within half the radius
    const bool inner = std::max(std::abs(2 * u - 1), std::abs(2 * v - 1)) <= 0.5;
    ASSERT_EQ(inner, p.norm() <= 0.5 + 1e-15);
  }
  const std::vector<double> expected(counts.size(), static_cast<double>(draws) / counts.size());
  EXPECT_GT(goodness_of_fit(counts, expected), 1e-3);
  EXPECT_EQ(disk_density({0.8, 0.7}), 0);
}

TEST(Warp, CornersOfTheSquareGiveUnitVectors) {
  const double last = 1 - 0x1p-53;
  for (const double u : {0.0, 0.5, last})
    for (const double v : {0.0, 0.5, last})
      for (const Warp& warp : warps()) {
        const Eigen::Vector3d drawn = warp.map({u, v});
        EXPECT_NEAR(drawn.norm(), 1, 1e-12) << warp.name;
        EXPECT_TRUE(std::isfinite(warp.density(drawn))) << warp.name;
      }
}

}  // namespace
}  // namespace scan::synth
