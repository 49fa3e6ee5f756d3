// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/slivers.h"

#include <gtest/gtest.h>

#include "libscan/reconstruct/collapsing_mesh.h"

namespace scan {
namespace {

double least_roundness(const Mesh& mesh) {
  double least = 1;
  for (const Triangle& t : mesh.triangles) {
    double longest2 = 0;
    for (int k = 0; k < 3; ++k)
      longest2 =
          std::max(longest2, (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).squaredNorm());
    least = std::min(least, 2 * area_vector(mesh, t).norm() / longest2);
  }
  return least;
}

// Two pyramids with a common base of the points around the origin.
Mesh double_pyramid(const std::vector<Eigen::Vector3d>& base) {
  Mesh mesh{base, {}};
  const auto n = static_cast<std::uint32_t>(base.size());
  mesh.vertices.push_back({0, 0, 1});
  mesh.vertices.push_back({0, 0, -1});
  for (std::uint32_t i = 0; i < n; ++i) {
    mesh.triangles.push_back({i, (i + 1) % n, n});
    mesh.triangles.push_back({(i + 1) % n, i, n + 1});
  }
  return mesh;
}

// A closed mesh with slivers loses them and nothing else.
void expect_mended(const Mesh& mesh) {
  ASSERT_TRUE(edge_census(mesh).watertight);
  ASSERT_LT(least_roundness(mesh), sliver_height);
  std::vector<std::uint32_t> vertex_of;
  const Mesh mended = without_slivers(mesh, std::vector<char>(mesh.vertices.size(), 1), vertex_of);
  EXPECT_GT(least_roundness(mended), sliver_height);
  const EdgeCensus census = edge_census(mended);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.non_manifold_vertices, 0u);
  EXPECT_EQ(census.genus, 0);
  EXPECT_NEAR(volume_m3(mended), volume_m3(mesh), 1e-12);
  ASSERT_EQ(vertex_of.size(), mended.vertices.size());
  for (std::size_t v = 0; v < vertex_of.size(); ++v)
    EXPECT_EQ(mended.vertices[v], mesh.vertices[vertex_of[v]]);
}

TEST(Slivers, OfNoLengthAreCollapsed) {
  expect_mended(double_pyramid({{1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}));
}

// The edge from (1, 0, 0) to (0, 1, 0) and vertices on it: one, or two, that make slivers below it
// while the triangles above it end at the edge's ends.
Mesh with_caps(int caps) {
  std::vector<Eigen::Vector3d> base = {{1, 0, 0}};
  for (int i = 1; i <= caps; ++i) {
    const double share = double(i) / (caps + 1);
    base.push_back({1 - share, share, 0});
  }
  base.insert(base.end(), {{0, 1, 0}, {-1, 0, 0}, {0, -1, 0}});
  Mesh mesh = double_pyramid(base);
  const auto top = static_cast<std::uint32_t>(base.size());
  const auto end = static_cast<std::uint32_t>(caps + 1);
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return t[2] == top && t[0] < end; });
  mesh.triangles.push_back({0, end, top});
  for (std::uint32_t i = 0; i + 1 < end; ++i) mesh.triangles.push_back({i, i + 1, end});
  return mesh;
}

TEST(Slivers, OnAnEdgeAreFlipped) {
  expect_mended(with_caps(1));
  expect_mended(with_caps(2));
}

// The edge from vertex 0 to 1 has vertices 2 and 3 on it: 2 belongs to the triangles below, 3 to
// those above, and the two slivers between them are each other's neighbours.
TEST(Slivers, BesideOneAnotherAreFlipped) {
  const Eigen::Vector3d a(1, 0, 0), b(0, 1, 0);
  Mesh mesh{{a, b, (2 * a + b) / 3, (a + 2 * b) / 3, {-1, 0, 0}, {0, -1, 0}}, {}};
  mesh.vertices.push_back({0, 0, 1});
  mesh.vertices.push_back({0, 0, -1});
  mesh.triangles = {{0, 3, 6}, {3, 1, 6}, {2, 0, 7}, {1, 2, 7}, {0, 1, 3}, {0, 2, 1},
                    {1, 4, 6}, {4, 5, 6}, {5, 0, 6}, {4, 1, 7}, {5, 4, 7}, {0, 5, 7}};
  expect_mended(mesh);
}

// A base of a hundredth is thin, but no sliver; and one that is not marked stays.
TEST(Slivers, AloneAreTakenOut) {
  const Mesh thin = double_pyramid({{1, 0, 0}, {0.005, 1, 0}, {-0.005, 1, 0}, {0, -1, 0}});
  std::vector<std::uint32_t> vertex_of;
  const Mesh same = without_slivers(thin, std::vector<char>(thin.vertices.size(), 1), vertex_of);
  EXPECT_TRUE(same.vertices == thin.vertices);
  EXPECT_TRUE(same.triangles == thin.triangles);
  const Mesh capped = with_caps(1);
  const Mesh left =
      without_slivers(capped, std::vector<char>(capped.vertices.size(), 0), vertex_of);
  EXPECT_TRUE(left.triangles == capped.triangles);
}

}  // namespace
}  // namespace scan
