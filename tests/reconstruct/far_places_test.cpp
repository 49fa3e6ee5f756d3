// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/far_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "libscan/reconstruct/ssd.h"
#include "libscan/reconstruct/ssd_fit.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

// Splines of equal coefficients are constant.
FarPlaces misjudged_by(double f, const Samples& samples) {
  const std::vector<int> depths(samples.points.size(), 4);
  const OctreeGrid grid = make_octree_grid(samples.points, depths, 4);
  LevelArrays coefficients = active_arrays(grid);
  for (double& c : coefficients.front()) c = f;
  return misjudged_places({grid, coefficients}, samples);
}

// How many of the cells' centres are farther than far_distance from a sphere, on one side; its
// samples, a fiftieth of the side apart, are farther than the sphere by at most (1/50)^2 / (2/16).
struct Count {
  std::size_t least = 0, most = 0;
};
Count centres(const UnitBox& box, double side) {
  Count count;
  for (int i = 0; i < 16 * 16 * 16; ++i) {
    const Eigen::Vector3d u(i % 16 + 0.5, i / 16 % 16 + 0.5, i / 256 + 0.5);
    const double distance = side * (box.to_world(u / 16).norm() - 1) / box.side_m;
    count.least += distance > far_distance;
    count.most += distance > far_distance - 0.0032;
  }
  return count;
}

TEST(FarPlaces, AreThoseOnTheWrongSideOfASphere) {
  const Samples samples = prepare_samples(sphere_cloud(20000));
  for (const double side : {1.0, -1.0}) {
    const FarPlaces found = misjudged_by(-side, samples);
    const Count expected = centres(samples.box, side);
    EXPECT_GE(found.places.size(), expected.least);
    EXPECT_LE(found.places.size(), expected.most);
    for (std::size_t i = 0; i < found.places.size(); ++i)
      EXPECT_NEAR(found.distances[i],
                  (samples.box.to_world(found.places[i]).norm() - 1) / samples.box.side_m, 0.0032);
  }
}

TEST(FarPlaces, AreNoneByAnOpenSurface) {
  PointCloud half = sphere_cloud(5000);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < half.size(); ++i)
    if (half.points[i][2] > 0) kept.push_back(i);
  const Samples samples = prepare_samples(subset(half, kept));
  EXPECT_TRUE(misjudged_by(-1, samples).places.empty());
  EXPECT_TRUE(misjudged_by(1, samples).places.empty());
}

// Between two spheres a patch of samples, all facing one of them, which leaves what is inside open
// to the other side. What is farther from all samples than far_distance and half a cell's diagonal
// lies in a cell whose centre is drawn to its side; the bubble reached 0.137 of the cube before.
TEST(FarPlaces, DrawInABubble) {
  PointCloud cloud;
  for (const double x : {-2.5, 2.5}) {
    const PointCloud sphere = sphere_cloud(10000, 0.5);
    for (const auto& p : sphere.points) cloud.points.push_back(p + Eigen::Vector3d(x, 0, 0));
    cloud.normals.insert(cloud.normals.end(), sphere.normals.begin(), sphere.normals.end());
  }
  for (int i = 0; i < 81 * 81; ++i) {
    cloud.points.push_back({0, 0.01 * (i % 81 - 40), 0.01 * (i / 81 - 40)});
    cloud.normals.push_back(Eigen::Vector3d::UnitX());
  }
  const SurfaceResult result = ssd(cloud);
  EXPECT_LT(*std::max_element(result.support_m.begin(), result.support_m.end()),
            (far_distance + std::sqrt(3.0) / 32) * prepare_samples(cloud).box.side_m);
  EXPECT_EQ(result.stop, SolveStop::converged);
}

struct SphereFit {
  Samples samples;
  OctreeGrid grid;
  SsdFit fit;
};

SphereFit sphere_fit(double sigma) {
  SphereFit sphere;
  sphere.samples = prepare_samples(scattered(sphere_cloud(20000), sigma));
  sphere.grid = make_octree_grid(sphere.samples.points, sample_depths(sphere.samples, 4, 6), 4);
  sphere.fit = fit_surface(sphere.grid, sphere.samples, {});
  return sphere;
}

// Places of two sides: one in the sphere's middle, one outside. With the distances that are true
// there the surface keeps its place: scatter all around would move it by sigma^2 / radius, 1.3e-4,
// were it not aimed at. With others f follows these: a place weighs 4 / 256 / distance^3, some ten
// times what bending resists with over such a distance.
TEST(FarPlaces, AreFollowedByAFit) {
  SphereFit sphere = sphere_fit(0.02);
  const double radius = 1 / sphere.samples.box.side_m;
  const Eigen::Vector3d middle = sphere.samples.box.to_unit({0, 0, 0});
  const Eigen::Vector3d corner = Eigen::Vector3d::Constant(0.03);
  const double outside = (corner - middle).norm() - radius;
  const auto f = [&](const Eigen::Vector3d& x) {
    return evaluate(SplineField{sphere.grid, sphere.fit.solution.coefficients}, x).value;
  };
  const auto offset = [&] {
    double sum = 0;
    for (const auto& n : sphere.samples.normals) sum += f(middle + radius * n);
    return sum / static_cast<double>(sphere.samples.normals.size());
  };
  const double before = offset();
  fit_again(sphere.grid, sphere.samples, {{middle, corner}, {-radius, outside}}, {}, sphere.fit);
  EXPECT_NEAR(offset(), before, 2e-5);
  fit_again(sphere.grid, sphere.samples, {{middle, corner}, {-0.06, 0.09}}, {}, sphere.fit);
  EXPECT_NEAR(f(middle), -0.06, 0.02);
  EXPECT_NEAR(f(corner), 0.09, 0.03);
}

}  // namespace
}  // namespace scan
