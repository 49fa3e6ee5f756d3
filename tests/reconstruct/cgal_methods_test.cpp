// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The methods that stand on CGAL give the same bytes wherever their memory lies.
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "libscan/reconstruct/delaunay.h"
#include "libscan/reconstruct/poisson.h"
#include "libscan/reconstruct/power_crust.h"
#include "libscan/reconstruct/scale_space.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

#ifdef LIBSCAN_WITH_CGAL

// Two thirds of many small blocks are free again, in a random order, and are what is given out
// next: addresses then follow no order of making, and another one for each seed. The large ones
// move what is larger.
class ScatteredHeap {
 public:
  explicit ScatteredHeap(std::uint64_t seed) {
    RandomStream random(seed, 0, 0);
    for (int i = 0; i < 300000; ++i) {
      const double least = i % 200 == 0 ? 1000 : 16;
      const auto bytes = static_cast<std::size_t>(least * (1 + 20 * random.uniform()));
      blocks_.push_back(std::make_unique<char[]>(bytes));
    }
    for (std::size_t i = blocks_.size(); i > 1; --i)
      std::swap(blocks_[i - 1], blocks_[static_cast<std::size_t>(i * random.uniform())]);
    while (blocks_.size() > 100000) blocks_.pop_back();
  }

 private:
  std::vector<std::unique_ptr<char[]>> blocks_;
};

PointCloud lattice_on_a_box() {
  PointCloud cloud;
  constexpr int n = 16;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k)
        if (i % n == 0 || j % n == 0 || k % n == 0) {
          const Eigen::Vector3d off(2 * i - n, 2 * j - n, 2 * k - n);
          const Eigen::Vector3d steep = (off.cwiseAbs().array() == n).select(off, 0);
          cloud.points.emplace_back(i, j, k);
          cloud.normals.push_back(steep.normalized());
        }
  return cloud;
}

PointCloud lattice_on_a_plane() {
  PointCloud cloud;
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j) cloud.points.emplace_back(i, j, 0);
  return cloud;
}

// So rough that advancing fronts end in pieces and take points out again.
PointCloud integers_about_a_sphere() {
  PointCloud cloud = scattered(sphere_cloud(3000, 100), 1);
  for (auto& x : cloud.points) x = x.array().round();
  return cloud;
}

PointCloud thin_plate() {
  PointCloud cloud;
  RandomStream random(7, 0, 0);
  while (cloud.size() < 8000) {
    const double up = cloud.size() % 2 ? 1 : -1;
    const double x = random.uniform(), y = random.uniform();
    cloud.points.emplace_back(x, y, 0.005 * up);
    cloud.normals.emplace_back(0, 0, up);
  }
  return cloud;
}

using Method = std::function<SurfaceResult(const PointCloud&)>;

void expect_the_same_wherever_memory_lies(const Method& method, const PointCloud& cloud) {
  const Mesh first = method(cloud).surface;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const ScatteredHeap heap(seed);
    const Mesh again = method(cloud).surface;
    EXPECT_EQ(again.vertices, first.vertices);
    ASSERT_EQ(again.triangles, first.triangles) << "seed " << seed;
  }
}

SurfaceResult crust(const PointCloud& cloud) {
  return power_crust(cloud, std::vector<double>(cloud.size(), 5));
}

TEST(Delaunay, IsTheSameWhereverMemoryLies) {
  expect_the_same_wherever_memory_lies(delaunay, lattice_on_a_box());
  expect_the_same_wherever_memory_lies(delaunay, lattice_on_a_plane());
  expect_the_same_wherever_memory_lies(delaunay, integers_about_a_sphere());
}

// All edges of its front are of equal value, and each counts.
TEST(Delaunay, ClosesABoxOfManyTies) {
  const Mesh box = delaunay(lattice_on_a_box()).surface;
  EXPECT_TRUE(edge_census(box).watertight);
  EXPECT_NEAR(volume_m3(box), 16 * 16 * 16, 1e-9);
}

TEST(ScaleSpace, IsTheSameWhereverMemoryLies) {
  expect_the_same_wherever_memory_lies(scale_space, lattice_on_a_box());
  expect_the_same_wherever_memory_lies(scale_space, lattice_on_a_plane());
  expect_the_same_wherever_memory_lies(scale_space, integers_about_a_sphere());
}

TEST(PowerCrust, IsTheSameWhereverMemoryLies) {
  expect_the_same_wherever_memory_lies(crust, lattice_on_a_box());
  expect_the_same_wherever_memory_lies(crust, integers_about_a_sphere());
}

TEST(Poisson, IsTheSameWhereverMemoryLies) {
  expect_the_same_wherever_memory_lies(poisson, lattice_on_a_box());
  expect_the_same_wherever_memory_lies(poisson, thin_plate());
}

#else

TEST(CgalMethods, AreTheSameWhereverMemoryLies) {
  GTEST_SKIP() << "built with LIBSCAN_WITH_CGAL=OFF";
}

#endif

}  // namespace
}  // namespace scan
