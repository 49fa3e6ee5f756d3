// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/ray_caster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "tests/synth/ray_scenes.h"
#include "tests/synth/structured_rays.h"

namespace scan::synth {
namespace {

// Moller and Trumbore 1997, over all triangles.
double nearest_by_brute_force(const Mesh& mesh, const Eigen::Vector3d& o,
                              const Eigen::Vector3d& d) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]], ab = mesh.vertices[t[1]] - a,
                          ac = mesh.vertices[t[2]] - a;
    const Eigen::Vector3d p = d.cross(ac), s = o - a, q = s.cross(ab);
    const double determinant = ab.dot(p);
    const double u = s.dot(p) / determinant, v = d.dot(q) / determinant;
    const double distance = ac.dot(q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0) nearest = std::min(nearest, distance);
  }
  return nearest;
}

TEST(RayCaster, FindsTheTriangleThatBruteForceFinds) {
  const Mesh mesh = bumpy_ball(20, 40);
  const RayCaster caster(scene_of({mesh}));
  int hits = 0;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    RandomStream random(1, 0, i);
    const Eigen::Vector3d origin = 3 * random_vector(random).normalized();
    const Eigen::Vector3d direction = (0.6 * random_vector(random) - origin).normalized();
    const auto hit = caster.closest(origin, direction);
    const double nearest = nearest_by_brute_force(mesh, origin, direction);
    ASSERT_EQ(hit.has_value(), std::isfinite(nearest)) << i;
    if (!hit) continue;
    ++hits;
    const double incidence = std::abs(hit->normal.dot(direction));
    EXPECT_NEAR(hit->distance_m, nearest, 1e-14 / std::max(incidence, 1e-6));
    EXPECT_NEAR((hit->point - (origin + nearest * direction)).norm(), 0, 1e-14 / incidence);
  }
  EXPECT_GT(hits, 2000);
}

// R1: rays from outside, aimed exactly at vertices and at points of edges of a closed mesh, hit its
// front. Being aimed at rounded targets, some pass a silhouette by a rounding; only targets on
// faces that all look at the origin are counted.
TEST(RayCaster, LeaksNowhereAtVerticesAndEdges) {
  const Mesh mesh = bumpy_ball(60, 120);
  const RayCaster caster(scene_of({mesh}));
  std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) around[v].push_back(t);
  const std::size_t count = 1'000'000;
  struct Count {
    std::size_t aimed = 0, leaks = 0;
    Count& operator+=(const Count& other) {
      aimed += other.aimed;
      leaks += other.leaks;
      return *this;
    }
  };
  const Count total = ordered_sum(count, 1000, Count{}, [&](std::size_t begin, std::size_t end) {
    Count part;
    for (std::size_t i = begin; i < end; ++i) {
      RandomStream random(2, 0, i);
      const Eigen::Vector3d origin = 2.5 * random_vector(random).normalized();
      const auto& t = mesh.triangles[random.bits32() % mesh.triangles.size()];
      const double share = i % 2 ? random.uniform() : 0;
      const Eigen::Vector3d target =
          mesh.vertices[t[0]] + share * (mesh.vertices[t[1]] - mesh.vertices[t[0]]);
      bool in_view = true;
      for (const int corner : {0, 1})
        for (const std::uint32_t face : around[t[corner]])
          in_view &= area_vector(mesh, mesh.triangles[face])
                         .normalized()
                         .dot((target - origin).normalized()) < -1e-6;
      if (!in_view) continue;
      ++part.aimed;
      const auto hit = caster.closest(origin, (target - origin).normalized());
      // the front is hit from outside; another part of the mesh may stand before the target
      part.leaks += !hit || hit->distance_m > (target - origin).norm() * (1 + 1e-9) ||
                    hit->normal.dot(target - origin) > 0;
    }
    return part;
  });
  EXPECT_GT(total.aimed, count / 4);
  EXPECT_EQ(total.leaks, 0u) << "of " << total.aimed;
}

// R1, the same from inside, where there is no silhouette and every ray counts; near and far from
// the origin, in packets. The full count of 1e9 is leak_count's, among the benchmarks.
TEST(RayCaster, LetsNoRayOutAtVerticesAndEdges) {
  for (const double offset_m : {0.0, 1e6}) {
    const Eigen::Vector3d centre(offset_m, -offset_m, offset_m);
    Mesh mesh = bumpy_ball(40, 80);
    for (Eigen::Vector3d& v : mesh.vertices) v += centre;
    EXPECT_EQ(count_leaks(RayCaster(scene_of({mesh})), mesh, centre, 1'000'000), 0u) << offset_m;
  }
}

// R1: along any line the crossings of a closed surface alternate between in and out.
TEST(RayCaster, CrossesAClosedMeshAnEvenNumberOfTimes) {
  const Mesh mesh = bumpy_ball(30, 60);
  const RayCaster caster(scene_of({mesh}));
  for (std::uint64_t i = 0; i < 20000; ++i) {
    RandomStream random(3, 0, i);
    const Eigen::Vector3d origin = 3 * random_vector(random).normalized();
    const Eigen::Vector3d direction = (0.6 * random_vector(random) - origin).normalized();
    int crossings = 0;
    double from = 0;
    while (const auto hit = caster.closest(origin, direction, from)) {
      ASSERT_EQ(hit->normal.dot(direction) < 0, crossings % 2 == 0) << i;
      from = hit->distance_m * (1 + 1e-12);
      ++crossings;
    }
    ASSERT_EQ(crossings % 2, 0) << i;
  }
}

// R2. An offset that doubles hold together with the scene's coordinates changes ranges by the
// rounding of the offset ray only.
TEST(RayCaster, GivesTheSameRangesFarFromTheOrigin) {
  const Mesh mesh = bumpy_ball(40, 80);
  const auto ranges_at = [&](double offset_m) {
    Scene scene = scene_of({mesh, Shape{TorusShape{1.5, 0.25}}, Shape{SphereShape{0.3}}},
                           at(offset_m, -offset_m, offset_m));
    scene.objects[2].world_from_object.translation().z() += 1.5;
    const RayCaster caster(scene);
    std::vector<double> ranges;
    for (std::uint64_t i = 0; i < 20000; ++i) {
      RandomStream random(4, 0, i);
      const Eigen::Vector3d origin =
          (random_vector(random).normalized() * 4 * 0x1p20).array().round() * 0x1p-20;
      const Eigen::Vector3d direction = (0.8 * random_vector(random) - origin).normalized();
      const auto hit =
          caster.closest(origin + Eigen::Vector3d(offset_m, -offset_m, offset_m), direction);
      ranges.push_back(hit ? hit->distance_m : -1);
    }
    return ranges;
  };
  const std::vector<double> near = ranges_at(0);
  for (const double offset_m : {1e3, 1e6, 1e7}) {
    const std::vector<double> far = ranges_at(offset_m);
    double largest = 0;
    for (std::size_t i = 0; i < near.size(); ++i)
      largest = std::max(largest, std::abs(far[i] - near[i]));
    EXPECT_LT(largest, 4e-9)
        << offset_m;  // 1e-9 of the extent of 4 m; a hit turned miss would be metres
  }
}

// R4.
TEST(RayCaster, NeverHitsTrianglesWithoutArea) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0},       {1, 0, 0},       {0.5, 0, 0},
                   {0.1, 0.3, 0.7}, {0.4, 1.2, 2.8}, {0.2, 0.6, 1.4}};
  mesh.triangles = {{0, 0, 0}, {0, 1, 2}, {0, 1, 1}, {3, 4, 5}};
  const RayCaster caster(scene_of({mesh}));
  for (std::uint64_t i = 0; i < 10000; ++i) {
    RandomStream random(5, 0, i);
    const Eigen::Vector3d target =
        i % 2 ? Eigen::Vector3d(random.uniform(), 0, 0)
              : Eigen::Vector3d(Eigen::Vector3d(0.1, 0.3, 0.7) * (1 + 3 * random.uniform()));
    const Eigen::Vector3d origin = target + 2 * random_vector(random).normalized();
    ASSERT_FALSE(caster.closest(origin, (target - origin).normalized()));
  }
}

TEST(RayCaster, HitsANeedleOnlyWhereItIs) {
  const double width = 1e-8;
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, width, 0}}, {{0, 1, 2}}};
  const RayCaster caster(scene_of({mesh}));
  const auto shot = [&](double x, double y) { return caster.closest({x, y, 1}, {0, 0, -1}); };
  const auto hit = shot(0.5, 0.25 * width);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->distance_m, 1);
  EXPECT_EQ(hit->normal, Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(shot(0.5, 0.51 * width));
  EXPECT_FALSE(shot(0.5, -0.01 * width));
}

// R5.
TEST(RayCaster, GivesCoincidentSurfacesToTheLowestObject) {
  const Mesh square{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Mesh turned{{{-1.1, -1, 0}, {1, -1.3, 0}, {1.2, 1, 0}, {-1, 1.4, 0}},
                    {{0, 1, 3}, {1, 2, 3}}};
  const Pose tilted = exp((Vector6() << 0.3, 0.2, 0.1, 5, 6, 7).finished());
  for (const bool swapped : {false, true}) {
    const RayCaster caster(swapped ? scene_of({turned, square, Shape{PlaneShape{}}}, tilted)
                                   : scene_of({square, turned, Shape{PlaneShape{}}}, tilted));
    for (std::uint64_t i = 0; i < 5000; ++i) {
      RandomStream random(6, 0, i);
      const Eigen::Vector3d target(1.8 * random.uniform() - 0.9, 1.8 * random.uniform() - 0.9, 0);
      const Eigen::Vector3d origin = target + Eigen::Vector3d(0.3, 0.1, 1);
      const auto hit =
          caster.closest(tilted * origin, tilted.linear() * (target - origin).normalized());
      ASSERT_TRUE(hit);
      EXPECT_EQ(hit->object, 0);
    }
  }
}

// R7.
TEST(RayCaster, HitsFromInsideAndNeverAtZero) {
  const Mesh mesh = bumpy_ball(40, 80);
  const RayCaster caster(scene_of({mesh}));
  for (std::uint64_t i = 0; i < 2000; ++i) {
    RandomStream random(10, 0, i);
    const Eigen::Vector3d direction = random_vector(random).normalized();
    const auto inside = caster.closest({0, 0, 0}, direction);
    ASSERT_TRUE(inside);
    EXPECT_GT(inside->normal.dot(direction), 0);
    const auto on = caster.closest(inside->point, direction);
    EXPECT_FALSE(on) << "the ray leaves for good";
  }
}

TEST(RayCaster, KeepsToTheIntervalAskedFor) {
  const RayCaster caster(scene_of({Shape{SphereShape{1}}}));
  const Eigen::Vector3d origin(0, 0, -3), direction(0, 0, 1);
  EXPECT_EQ(caster.closest(origin, direction)->distance_m, 2);
  EXPECT_EQ(caster.closest(origin, direction, 2.5)->distance_m, 4);
  EXPECT_FALSE(caster.closest(origin, direction, 0, 1.9));
  EXPECT_FALSE(caster.closest(origin, direction, 4.5));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(caster.closest({nan, 0, 0}, direction));
  EXPECT_FALSE(RayCaster(Scene{}).closest(origin, direction));
}

TEST(RayCaster, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Mesh mesh = bumpy_ball(60, 120);
  const auto bytes = [&](int threads) {
    const ThreadLimit limit(threads);
    const RayCaster caster(scene_of({mesh, Shape{TorusShape{1.2, 0.2}}}));
    std::vector<double> ranges(20000, -1);
    parallel_for(ranges.size(), [&](std::size_t i) {
      RandomStream random(11, 0, i);
      const Eigen::Vector3d origin = 3 * random_vector(random).normalized();
      if (const auto hit =
              caster.closest(origin, (0.6 * random_vector(random) - origin).normalized()))
        ranges[i] = hit->distance_m;
    });
    return ranges;
  };
  const auto one = bytes(1);
  for (const int threads : {2, 7}) {
    const auto other = bytes(threads);
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(double)), 0) << threads;
  }
}

TEST(RayCaster, RefusesABrokenMesh) {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}};
  EXPECT_THROW(RayCaster(scene_of({mesh})), Error);
  mesh.triangles = {{0, 1, 2}};
  mesh.vertices[1].y() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(RayCaster(scene_of({mesh})), Error);
}

}  // namespace
}  // namespace scan::synth
