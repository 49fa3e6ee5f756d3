// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/packet_entry.h"

#include <gtest/gtest.h>

#include <limits>

#include "libscan/core/random.h"
#include "synth/shape_rays.h"

namespace scan::synth {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Coordinates on a coarse grid: rays along faces, through corners and in the box's planes are
// common, and so are directions without one or two axes.
Ray grid_ray(RandomStream& random) {
  const auto step = [&](double least, int steps) {
    return least + static_cast<double>(static_cast<int>(random.uniform() * steps)) * 0.5;
  };
  Ray ray{.origin = {0, 0, 0}, .direction = {0, 0, 0}};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin(axis) = step(-2, 10);
    ray.direction(axis) = step(-0.5, 3);
  }
  if (ray.direction.isZero(0)) ray.direction.z() = 1;
  ray.direction.normalize();
  ray.min_m = random.uniform() < 0.3 ? random.uniform() : 0;
  ray.max_m = random.uniform() < 0.3 ? 3 * random.uniform() : infinity;
  return ray;
}

double entry_of(const Bounds& bounds, const Ray& ray) {
  if (bounds.contains(ray.origin)) return 0;
  const auto span = clip(bounds, ray);
  return span ? span->enter_m : infinity;
}

TEST(PacketEntry, IsThatOfEachRayByEveryKernel) {
  const Box box{{-0.5, -1, 0}, {1, 0.5, 1.5}};
  const Bounds bounds(Eigen::Vector3d(-0.5, -1, 0), Eigen::Vector3d(1, 0.5, 1.5));
  RandomStream random(5, 0, 0);
  int inside = 0, before = 0, missed = 0;
  for (int packet = 0; packet < 5000; ++packet) {
    RaysByAxis rays;
    double expected_m[RaysByAxis::size];
    for (std::size_t i = 0; i < RaysByAxis::size; ++i) {
      const Ray ray = grid_ray(random);
      for (int axis = 0; axis < 3; ++axis) {
        rays.origin[axis][i] = ray.origin(axis);
        rays.direction[axis][i] = ray.direction(axis);
      }
      rays.min_m[i] = ray.min_m;
      rays.max_m[i] = ray.max_m;
      expected_m[i] = entry_of(bounds, ray);
      ++(expected_m[i] == 0 ? inside : expected_m[i] < infinity ? before : missed);
    }
    for (EntryKernel* const kernel : entry_kernels()) {
      double start_m[RaysByAxis::size];
      kernel(rays, box, start_m);
      for (std::size_t i = 0; i < RaysByAxis::size; ++i) ASSERT_EQ(start_m[i], expected_m[i]) << i;
    }
  }
  EXPECT_GT(inside, 1000);
  EXPECT_GT(before, 1000);
  EXPECT_GT(missed, 1000);
}

}  // namespace
}  // namespace scan::synth
