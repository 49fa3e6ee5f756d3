// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/blended_field.h"

#include <gtest/gtest.h>

#include "libscan/reconstruct/isosurface.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

double sum_of(const PartShares& shares) {
  double sum = 0;
  for (int k = 0; k < shares.count; ++k) sum += shares.parts[k].share;
  return sum;
}

double share_of(const PartShares& shares, std::uint32_t part) {
  for (int k = 0; k < shares.count; ++k)
    if (shares.parts[k].part == part) return shares.parts[k].share;
  return 0;
}

TEST(PartShares, AddUpToOne) {
  RandomStream random(1, 0, 0);
  int blended = 0;
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const PartShares shares = shares_at({x, y, z}, 2);
    EXPECT_NEAR(sum_of(shares), 1, 1e-15);
    blended += shares.count > 1;
  }
  // Three walls an axis, a 32nd of the cube wide each.
  EXPECT_NEAR(blended / 2000.0, 1 - std::pow(1 - 3.0 / 32, 3), 4 * std::sqrt(0.25 / 2000));
}

TEST(PartShares, GoFromOnePartToTheNext) {
  EXPECT_EQ(share_of(shares_at({0.4, 0.2, 0.2}, 1), 0), 1);
  EXPECT_EQ(share_of(shares_at({0.6, 0.2, 0.2}, 1), 1), 1);
  EXPECT_EQ(share_of(shares_at({0.5, 0.2, 0.2}, 1), 1), 0.5);
  EXPECT_EQ(share_of(shares_at({0.5, 0.5, 0.5}, 1), 7), 0.125);
  EXPECT_EQ(shares_at({0, 1, 0}, 1).count, 1);  // no part lies behind the cube's walls
  // The steepest slope is 15 / 8 over the width of 1/16.
  for (int i = 0; i < 1000; ++i) {
    const double x = i / 1000.0;
    const double step =
        share_of(shares_at({x + 1e-4, 0.2, 0.2}, 1), 1) - share_of(shares_at({x, 0.2, 0.2}, 1), 1);
    EXPECT_GE(step, 0);
    EXPECT_LE(step, 1e-4 * 15 / 8 * 16 * (1 + 1e-9));
  }
}

struct RandomFields {
  std::vector<OctreeGrid> grids;
  std::vector<LevelArrays> coefficients;

  RandomFields(std::uint64_t seed, int count) {
    RandomStream random(seed, 0, 0);
    for (int f = 0; f < count; ++f) {
      std::vector<Eigen::Vector3d> points;
      for (int i = 0; i < 4; ++i) {
        const double x = random.uniform(), y = random.uniform(), z = random.uniform();
        points.emplace_back(x, y, z);
      }
      grids.push_back(make_octree_grid(points, std::vector<int>(4, 5), 3));
      coefficients.push_back(active_arrays(grids.back()));
      for (auto& level : coefficients.back())
        for (double& c : level) c = random.normal();
    }
  }
  SplineField field(std::size_t f) const { return {grids[f], coefficients[f]}; }
};

// Fields that have nothing in common: where they are blended, cells must still decide alike.
TEST(BlendedField, HasAClosedManifoldForRandomFields) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const RandomFields fields(seed, 5);
    BlendedField blended{1, {}, {0, 1, 2, 3, 4, 0, 0, 1}};
    for (std::size_t f = 0; f < 5; ++f) blended.fields.push_back(fields.field(f));
    const Mesh mesh = zero_level_set(blended, 6);
    const EdgeCensus census = edge_census(mesh);
    EXPECT_TRUE(census.watertight) << "seed " << seed;
    EXPECT_EQ(census.non_manifold_edges, 0u);
    EXPECT_EQ(census.misoriented_edges, 0u);
    EXPECT_GT(volume_m3(mesh), 0);
  }
}

TEST(BlendedField, OfEqualFieldsIsTheField) {
  const RandomFields fields(7, 1);
  const Mesh alone = zero_level_set(fields.field(0), 6);
  const RandomFields same(7, 1);
  BlendedField blended{2, {fields.field(0), same.field(0)}, {}};
  for (std::uint32_t part = 0; part < 64; ++part) blended.field_of_part.push_back(part % 2);
  const Mesh found = zero_level_set(blended, 6);
  ASSERT_EQ(found.triangles.size(), alone.triangles.size());
  ASSERT_EQ(found.vertices.size(), alone.vertices.size());
  // Coefficients differ by rounding, 1e-15; roots by that over the slope, which is seldom small.
  std::size_t off = 0;
  for (std::size_t i = 0; i < found.vertices.size(); ++i)
    off += (found.vertices[i] - alone.vertices[i]).norm() > 1e-12;
  EXPECT_LT(off, found.vertices.size() / 1000 + 1);
}

}  // namespace
}  // namespace scan
