// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/grains.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/random.h"

namespace scan {
namespace {

constexpr std::size_t count = 4000;

struct Placed {
  std::vector<Eigen::Vector3d> points, feet, normals;
  std::vector<double> trust, reach;
};

Placed anywhere() {
  Placed p;
  for (std::uint64_t i = 0; i < count; ++i) {
    RandomStream random(1, 0, i);
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const double u = random.normal(), v = random.normal(), w = random.normal();
    p.feet.emplace_back(x, y, z);
    p.normals.push_back(Eigen::Vector3d(u, v, w).normalized());
    p.points.push_back(p.feet.back() + 0.1 * random.normal() * p.normals.back());
    p.trust.push_back(1 - 0.9 * random.uniform());
    p.reach.push_back(random.uniform() < 0.5 ? 0.4 : 1.5);
  }
  return p;
}

TEST(Grains, HoldWhatIsWithinAFifthOfTheirReachAndFacesOneWay) {
  const Placed p = anywhere();
  const auto grain_of = grains_of(p.feet, p.normals, p.reach);
  std::size_t together = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (grain_of[i] != grain_of[j]) continue;
      ++together;
      ASSERT_EQ(p.reach[i], p.reach[j]);
      ASSERT_LE((p.feet[i] - p.feet[j]).cwiseAbs().maxCoeff(), p.reach[i] / 5);
      Eigen::Index one = 0, other = 0;
      p.normals[i].cwiseAbs().maxCoeff(&one);
      p.normals[j].cwiseAbs().maxCoeff(&other);
      ASSERT_EQ(one, other);
      ASSERT_GT(p.normals[i][one] * p.normals[j][one], 0);
    }
  EXPECT_GT(together, count);
}

// (n_i + n_j) . (p_j - p_i) summed over j by the grains' sums or one by one: sums of 4,000 terms
// below 3 differ by rounding alone.
TEST(Grains, SumAsTheirSamplesDo) {
  const Placed p = anywhere();
  const auto grain_of = grains_of(p.feet, p.normals, p.reach);
  const auto grains = summed_grains(grain_of, {p.points, p.feet, p.normals, p.trust});
  EXPECT_LT(grains.size(), count);
  const Eigen::Vector3d &n = p.normals[7], &x = p.points[7];
  double by_grains = 0, by_samples = 0;
  for (const Grain& g : grains)
    by_grains += n.dot(g.points - g.trust * x) + g.points_along_normals - g.normals.dot(x);
  for (std::size_t j = 0; j < count; ++j)
    by_samples += p.trust[j] * (n + p.normals[j]).dot(p.points[j] - x);
  EXPECT_NEAR(by_grains, by_samples, 1e-10);
  Eigen::Vector3d feet = Eigen::Vector3d::Zero();
  for (const Grain& g : grains) feet += g.trust * g.foot();
  for (std::size_t j = 0; j < count; ++j) feet -= p.trust[j] * p.feet[j];
  EXPECT_LT(feet.norm(), 1e-10);
}

}  // namespace
}  // namespace scan
