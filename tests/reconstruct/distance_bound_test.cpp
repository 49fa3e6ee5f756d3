// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/distance_bound.h"

#include <gtest/gtest.h>

#include "libscan/core/random.h"

namespace scan {
namespace {

// The unit square, `cells` a side, at a height that depends on the place.
template <class Height>
Mesh square(std::uint32_t cells, Height height) {
  Mesh mesh;
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const double x = double(i) / cells, y = double(j) / cells;
      mesh.vertices.push_back({x, y, height(x, y)});
    }
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = i + (cells + 1) * j, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

double flat(double, double) {
  return 0;
}

// Parts of 2^-12 that lie across a seam of the other mesh see one of its triangles from as far to
// the side: 0.1 grows by (2^-12)^2 / 0.2 = 3e-7.
TEST(DistanceBound, IsExactBetweenParallelSquares) {
  const Mesh coarse = square(1, flat);
  const Mesh fine = square(9, [](double, double) { return 0.1; });
  const auto bound = two_sided_bound(coarse, fine, 0.1 + 4e-7);
  ASSERT_TRUE(bound);
  EXPECT_NEAR(*bound, 0.1, 4e-7);
  EXPECT_FALSE(two_sided_bound(coarse, fine, 0.1 - 1e-12));
}

// No vertex of the flat square is farther than the sides of the pyramid; its middle is 0.5 below.
TEST(DistanceBound, SeesWhatNoVertexShows) {
  const Mesh sheet = square(1, flat);
  Mesh bump = square(2, [](double x, double y) { return x == 0.5 && y == 0.5 ? 0.5 : 0; });
  EXPECT_FALSE(distance_bound(sheet, bump, MeshSearch(bump), 0.2));
  EXPECT_FALSE(distance_bound(bump, sheet, MeshSearch(sheet), 0.499));
  EXPECT_TRUE(distance_bound(bump, sheet, MeshSearch(sheet), 0.501));
}

// Never below what samples show, and at most a hundredth above where the limit leaves it that.
TEST(DistanceBound, HoldsForSamplesOfRoughSurfaces) {
  RandomStream random(1, 0, 0);
  const auto rough = [&](double, double) { return 0.05 * random.uniform(); };
  const Mesh a = square(6, rough), b = square(5, rough);
  const MeshSearch search(b);
  double largest = 0;
  for (const SurfaceSample& s : sample_surface(a, 200'000, 1))
    largest = std::max(largest, search.closest(s.point).distance_m);
  EXPECT_FALSE(distance_bound(a, b, search, largest));
  const auto bound = distance_bound(a, b, search, 1.01 * largest);
  ASSERT_TRUE(bound);
  EXPECT_GE(*bound, largest);
}

}  // namespace
}  // namespace scan
