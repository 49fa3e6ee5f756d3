// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/choose_method.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

PointCloud cap(std::size_t count) {
  const PointCloud sphere = sphere_cloud(count);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < sphere.size(); ++i)
    if (sphere.points[i][2] > 0.3) kept.push_back(i);
  return subset(sphere, kept);
}

// Seen from a sphere, the part dA of it at distance r fills dA / (8 pi r) of all directions. In
// Legendre's polynomials 1 / r between two places on the unit sphere is the sum of P_l(cos), whose
// double integral over the cap z > c is (2 pi (P_{l-1}(c) - P_{l+1}(c)) / (2 l + 1))^2.
double missing_of_cap(double c) {
  const double ring = 2 * std::numbers::pi;
  double sum = std::pow(ring * (1 - c), 2);
  for (unsigned l = 1; l < 200; ++l)
    sum += std::pow(ring * (std::legendre(l - 1, c) - std::legendre(l + 1, c)) / (2 * l + 1), 2);
  return 1 - 2 * sum / (8 * std::numbers::pi * ring * (1 - c));
}

// The samples' areas come out too small by up to 0.07 (WindingNumber's test). It goes by cells of
// 1/32 of the box and leaves a place's own out: seen from within it a disc of radius r on a sphere
// of radius R fills r / (4 R) of all directions, for one as large as a cell 0.6 / (4 * 16) = 0.01,
// twice that of those behind; on the tube of the torus twice that again.
constexpr double by_samples = 0.1;

TEST(ChooseMethod, TakesSsdForAClosedSurface) {
  const PointCloud outward = torus_cloud(10000);
  PointCloud inward = outward;
  for (auto& normal : inward.normals) normal = -normal;
  for (const PointCloud& cloud : {outward, inward}) {
    const MethodChoice choice = choose_method(prepare_points(cloud, {}));
    EXPECT_EQ(choice.method, ReconstructMethod::ssd);
    EXPECT_LT(choice.open_share, 1.2 * by_samples);
    EXPECT_EQ(choice.trim_m, 0);
    EXPECT_NE(choice.reason.find("closed"), std::string::npos);
  }
}

TEST(ChooseMethod, TellsAnEndFromHolesAtAnyDensity) {
  EXPECT_NEAR(missing_of_cap(-1), 0, 1e-12);
  for (const std::size_t count : {3000u, 30000u, 100000u}) {
    SCOPED_TRACE(count);
    const MethodChoice open = choose_method(prepare_points(cap(count), {}));
    EXPECT_EQ(open.method, ReconstructMethod::mls);
    EXPECT_NEAR(open.open_share, missing_of_cap(0.3), by_samples);
    const PointCloud whole = sphere_cloud(count);
    std::vector<std::uint32_t> kept;  // without six caps of half-angle 0.3
    for (std::uint32_t i = 0; i < whole.size(); ++i)
      if (whole.points[i].cwiseAbs().maxCoeff() < std::cos(0.3)) kept.push_back(i);
    const MethodChoice holes = choose_method(prepare_points(subset(whole, kept), {}));
    EXPECT_EQ(holes.method, ReconstructMethod::ssd);
    // Six of the caps, 3 (1 - cos 0.3) of the sphere, evenly spread.
    EXPECT_NEAR(holes.open_share, 3 * (1 - std::cos(0.3)), by_samples);
  }
}

// 200 times as dense at one end as at the other: chains of lonely points are no rims.
TEST(ChooseMethod, TakesAnUnevenlySampledSurfaceForClosed) {
  const PointCloud even = torus_cloud(50000);
  RandomStream random(7, 0, 0);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < even.size(); ++i)
    if (random.uniform() < std::pow(200.0, -(even.points[i][0] + 1.35) / 2.7)) kept.push_back(i);
  EXPECT_EQ(choose_method(prepare_points(subset(even, kept), {})).method, ReconstructMethod::ssd);
}

// Fusion is farther from the truth on all scans that were measured: docs/results.md, "Surfaces".
TEST(ChooseMethod, DoesNotAskForTheScannersPlaces) {
  const PointCloud open = cap(10000);
  std::vector<Eigen::Vector3d> scanners;
  for (const auto& x : open.points) scanners.push_back(3 * x);
  EXPECT_EQ(choose_method(prepare_points(open, scanners)).method, ReconstructMethod::mls);
}

// The lid over the cap is as wide as it: trimmed, no vertex is farther from a point than trim_m.
TEST(ChooseMethod, TrimsANoisyOpenSurface) {
  const PointCloud noisy = scattered(cap(10000), 0.02);
  const MethodChoice choice = choose_method(prepare_points(noisy, {}));
  EXPECT_GT(choice.unflatness, 0.25);
  EXPECT_EQ(choice.method, ReconstructMethod::ssd);
  EXPECT_GT(choice.trim_m, 0);
  const SurfaceResult result =
      reconstruct(noisy, {}, {.method = ReconstructMethod::automatic, .ssd = {.depth = 6}});
  EXPECT_GT(result.trimmed_area_m2, 0);
  EXPECT_LE(*std::max_element(result.support_m.begin(), result.support_m.end()), choice.trim_m);
}

TEST(ChooseMethod, IsToldInTheResult) {
  const SurfaceResult result = reconstruct(
      torus_cloud(2000), {}, {.method = ReconstructMethod::automatic, .ssd = {.depth = 5}});
  EXPECT_EQ(result.method, "ssd");
  EXPECT_NE(result.method_reason.find("closed"), std::string::npos);
}

}  // namespace
}  // namespace scan
