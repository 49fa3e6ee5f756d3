// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/trim.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

struct Accuracy {
  double mean_m = 0;
  double normal_rad = 0;
};

// Means over the surface, by facet middles; `distance` and `normal` are the truth's.
template <class Distance, class Normal>
Accuracy accuracy(const Mesh& mesh, Distance&& distance, Normal&& normal) {
  Accuracy sum;
  double total = 0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d middle =
        (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
    const Eigen::Vector3d area = area_vector(mesh, t);
    const double weight = area.norm();
    sum.mean_m += weight * std::abs(distance(middle));
    const Eigen::Vector3d n = normal(middle);
    sum.normal_rad += weight * std::atan2(area.cross(n).norm(), area.dot(n));
    total += weight;
  }
  return {sum.mean_m / total, sum.normal_rad / total};
}

constexpr double degree = std::numbers::pi / 180;

// The figures that SSD on exact samples must reach: a mean of 5e-5 of the box's diagonal, 1 degree.
TEST(Ssd, FindsATorusFromExactSamples) {
  const SurfaceResult result = ssd(torus_cloud(100000), {.depth = 8});
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.components, 1u);
  EXPECT_EQ(census.genus, 1);
  EXPECT_EQ(result.stop, SolveStop::converged);
  const auto ring = [](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(Eigen::Vector3d(x[0], x[1], 0).normalized());
  };
  const Accuracy error = accuracy(
      result.surface, [&](const Eigen::Vector3d& x) { return (x - ring(x)).norm() - 0.35; },
      [&](const Eigen::Vector3d& x) { return (x - ring(x)).normalized().eval(); });
  const double diagonal = std::sqrt(2 * 2.7 * 2.7 + 0.7 * 0.7);
  EXPECT_LT(error.mean_m, 5e-5 * diagonal);
  EXPECT_LT(error.normal_rad, degree);
}

// At 10,000 points the spacing is 0.035 R and the cells 2^-6 of the box, facets half of that: the
// sagitta of a facet of 0.02 R is 5e-5 R, its slope 0.01 rad at its rim.
TEST(Ssd, FindsASphere) {
  const SurfaceResult result = ssd(sphere_cloud(10000), {.depth = 7});
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.components, 1u);
  EXPECT_EQ(census.genus, 0);
  EXPECT_GT(volume_m3(result.surface), 0);
  const Accuracy error = accuracy(
      result.surface, [](const Eigen::Vector3d& x) { return x.norm() - 1; },
      [](const Eigen::Vector3d& x) { return x.normalized().eval(); });
  EXPECT_LT(error.mean_m, 5e-4);
  EXPECT_LT(error.normal_rad, degree);
  EXPECT_EQ(result.support_m.size(), result.surface.vertices.size());
  for (const double support : result.support_m) EXPECT_LT(support, 0.2);
}

// Linear functions have no bending energy, so a plane is found as exactly as the solver stops.
TEST(Ssd, ReproducesAPlane) {
  PointCloud cloud;
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, 5).normalized();
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    Eigen::Vector3d x(random.uniform(), random.uniform(), 0);
    x[2] = -(normal[0] * x[0] + normal[1] * x[1]) / normal[2];
    cloud.points.push_back(x);
    cloud.normals.push_back(normal);
  }
  SurfaceResult result = ssd(cloud, {.depth = 5, .relative_residual = 1e-10});
  EXPECT_TRUE(edge_census(result.surface).watertight);
  trim(result, 0.05);
  ASSERT_FALSE(result.surface.empty());
  // The energy norm is accurate to 1e-10; a value at a point follows with the root of the ratio of
  // the gradient's and the value's share, about 10. The snap guard adds nothing along the plane's
  // edges but 5e-4 of a cell where the plane passes a corner nearly.
  std::size_t off = 0;
  for (const auto& v : result.surface.vertices) {
    EXPECT_NEAR(normal.dot(v), 0, 5e-4 * result.finest_cell_m);
    off += std::abs(normal.dot(v)) > 1e-8;
  }
  EXPECT_LT(off, result.surface.vertices.size() / 50);
}

bool equal_bytes(const SurfaceResult& a, const SurfaceResult& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
  };
  return same(a.surface.vertices, b.surface.vertices) &&
         same(a.surface.triangles, b.surface.triangles) && same(a.support_m, b.support_m);
}

TEST(Ssd, GivesTheSameBytesForAnyThreadCount) {
  const PointCloud cloud = torus_cloud(4000);
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return ssd(cloud, {.depth = 6});
  };
  const SurfaceResult one = with_threads(1);
  EXPECT_TRUE(equal_bytes(one, with_threads(2)));
  EXPECT_TRUE(equal_bytes(one, with_threads(7)));
}

TEST(Ssd, DoesNotDependOnTheOrderOfPoints) {
  const PointCloud cloud = torus_cloud(3000);
  std::vector<std::uint32_t> reversed;
  for (std::uint32_t i = 3000; i-- > 0;) reversed.push_back(i);
  EXPECT_TRUE(equal_bytes(ssd(cloud, {.depth = 5}), ssd(subset(cloud, reversed), {.depth = 5})));
}

Trouble trouble_of(const PointCloud& cloud, const SsdOptions& options = {.depth = 5}) {
  try {
    ssd(cloud, options);
  } catch (const Error& error) {
    return error.trouble();
  }
  ADD_FAILURE() << "no error";
  return Trouble::output;
}

TEST(Ssd, RefusesInputThatHoldsNoSurface) {
  EXPECT_EQ(trouble_of({}), Trouble::input);
  EXPECT_EQ(trouble_of(sphere_cloud(1)), Trouble::input);
  EXPECT_EQ(trouble_of(sphere_cloud(15)), Trouble::input);
  PointCloud no_normals = sphere_cloud(100);
  no_normals.normals.clear();
  EXPECT_EQ(trouble_of(no_normals), Trouble::input);
  PointCloud zero_normals = sphere_cloud(100);
  for (auto& n : zero_normals.normals) n.setZero();
  EXPECT_EQ(trouble_of(zero_normals), Trouble::input);
  PointCloud one_place = sphere_cloud(100);
  for (auto& x : one_place.points) x = {1, 2, 3};
  EXPECT_EQ(trouble_of(one_place), Trouble::input);
}

TEST(Ssd, RefusesOptionsOutsideTheirLimits) {
  EXPECT_EQ(trouble_of(sphere_cloud(100), {.depth = 2}), Trouble::usage);
  EXPECT_EQ(trouble_of(sphere_cloud(100), {.depth = 13}), Trouble::usage);
  EXPECT_EQ(trouble_of(sphere_cloud(100), {.sigma_m = -1}), Trouble::usage);
  EXPECT_EQ(trouble_of(sphere_cloud(100), {.relative_residual = -1e-3}), Trouble::usage);
}

TEST(Ssd, LeavesOutAndCountsBadPoints) {
  PointCloud cloud = sphere_cloud(3000);
  const SurfaceResult clean = ssd(cloud, {.depth = 5});
  cloud.points.push_back(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  cloud.normals.push_back(Eigen::Vector3d::UnitX());
  cloud.points.push_back({0.1, 0.2, 0.3});
  cloud.normals.push_back(Eigen::Vector3d::Zero());
  const SurfaceResult result = ssd(cloud, {.depth = 5});
  EXPECT_EQ(result.invalid_points, 2u);
  EXPECT_TRUE(equal_bytes(result, clean));
}

}  // namespace
}  // namespace scan
