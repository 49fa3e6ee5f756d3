// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The ray caster against its oracle: single rays, packets and the slow tracer agree to the bit.
#include "synth/reference_tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/synth/ray_scenes.h"

namespace scan::synth {
namespace {

bool same(const std::optional<Hit>& a, const std::optional<Hit>& b) {
  if (!a || !b) return !a && !b;
  return a->distance_m == b->distance_m && a->point == b->point && a->normal == b->normal &&
         a->object == b->object && a->triangle == b->triangle && a->error_m == b->error_m;
}

Eigen::Vector3d in_cube(RandomStream& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return {2 * x - 1, 2 * y - 1, 2 * z - 1};
}

// Triangles of all proportions: from equilateral to needles and caps of 1e-9, in all sizes.
Mesh scrap(std::size_t count) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    RandomStream random(21, 0, i);
    const Eigen::Vector3d a = in_cube(random);
    const Eigen::Vector3d along = random_vector(random) * std::pow(10, -3 * random.uniform());
    const double share = random.uniform();
    const Eigen::Vector3d across = along.norm() * random_vector(random).normalized();
    mesh.vertices.insert(
        mesh.vertices.end(),
        {a, a + along, a + share * along + std::pow(10, -9 * random.uniform()) * across});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// A floor of squares, twice in other cuts, and once more turned over: coplanar and coincident.
Mesh floor_mesh(bool other_diagonal) {
  Mesh mesh;
  for (int i = 0; i <= 6; ++i)
    for (int j = 0; j <= 6; ++j) mesh.vertices.push_back({i / 3.0 - 1, j / 3.0 - 1, 0.25});
  for (std::uint32_t i = 0; i < 6; ++i)
    for (std::uint32_t j = 0; j < 6; ++j) {
      const std::uint32_t a = 7 * i + j, b = a + 7, c = a + 8, d = a + 1;
      if (other_diagonal) {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      } else {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      }
    }
  return mesh;
}

Mesh turned_over(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  return mesh;
}

Scene hard_scene(const Pose& pose, bool with_shapes) {
  const Mesh ball = bumpy_ball(14, 20);
  Scene scene = scene_of(
      {scrap(300), floor_mesh(true), ball, floor_mesh(false), turned_over(floor_mesh(true)), ball},
      pose);
  if (with_shapes) {
    scene.objects.push_back({"", pose * at(0.1, 0, 0.25), Shape{PlaneShape{}}, 0});
    scene.objects.push_back({"", pose * at(0.5, 0, 0), Shape{SphereShape{0.3}}, 0});
    scene.objects.push_back({"", pose * at(0, 0.2, 0.2), Shape{BoxShape{{0.3, 0.4, 0.1}, 0}}, 0});
  }
  return scene;
}

const Mesh& any_mesh(const Scene& scene, RandomStream& random) {
  return std::get<Mesh>(scene.objects[random.bits32() % 6].geometry);
}

// A place on a random triangle: a corner, a point of an edge, or inside.
Eigen::Vector3d target_on(const Scene& scene, const Pose& pose, RandomStream& random,
                          Eigen::Vector3d& in_plane) {
  const Mesh& mesh = any_mesh(scene, random);
  const Triangle& t = mesh.triangles[random.bits32() % mesh.triangles.size()];
  const Eigen::Vector3d a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
  const std::uint32_t kind = random.bits32() % 3;
  const double v = kind == 0 ? 0 : random.uniform(), w = kind < 2 ? 0 : random.uniform() * (1 - v);
  const double turn = 2 * std::numbers::pi * random.uniform();
  in_plane = pose.linear() *
             (std::cos(turn) * (b - a).normalized() + std::sin(turn) * (c - a).normalized());
  return pose * Eigen::Vector3d(a + v * (b - a) + w * (c - a));
}

// Rays in nearly the same direction side by side, so that they travel in packets.
void sort_by_direction(std::vector<Ray>& rays) {
  const auto cell = [](const Ray& ray) {
    const Eigen::Array3d place = (3 * ray.direction).array().round();
    return place.x() + 7 * place.y() + 49 * place.z();
  };
  std::stable_sort(rays.begin(), rays.end(),
                   [&](const Ray& a, const Ray& b) { return cell(a) < cell(b); });
}

// At random, at corners and edges, along surfaces, and from one surface to another.
std::vector<Ray> hard_rays(const Scene& scene, const Pose& pose, std::size_t count) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(22, 0, i);
    Eigen::Vector3d in_plane, ignored;
    const Eigen::Vector3d target = target_on(scene, pose, random, in_plane);
    Eigen::Vector3d origin = pose * Eigen::Vector3d(1.5 * random_vector(random));
    const double tilt = random.normal() * std::pow(10, -16 * random.uniform());
    const Eigen::Vector3d off = random_vector(random);
    if (i % 4 == 1) origin = target - (in_plane + tilt * off) * random.uniform();
    if (i % 4 == 2) origin = target_on(scene, pose, random, ignored);
    if (i % 16 == 3) origin = target + 1e5 * off;
    const Eigen::Vector3d direction = target - origin;
    if (!(direction.norm() > 0)) continue;
    rays.push_back({origin, direction.normalized()});
    if (i % 5 == 0) rays.back().max_m = direction.norm();
    if (i % 7 == 0) rays.back().min_m = direction.norm();
  }
  sort_by_direction(rays);
  return rays;
}

struct Case {
  Pose pose;
  bool with_shapes;
};
std::vector<Case> cases() {
  const Pose tilted = exp((Vector6() << 0.3, 0.2, 0.1, 5, 6, 7).finished());
  return {{Pose::Identity(), true},
          {tilted, false},
          {at(1e6, -1e6, 1e6), true},
          {at(1e6, 2e6, -3e6) * tilted, false}};
}

TEST(ReferenceTracer, AgreesWithTheCasterToTheBit) {
  for (const auto& [pose, with_shapes] : cases()) {
    const Scene scene = hard_scene(pose, with_shapes);
    const RayCaster caster(scene);
    const ReferenceTracer oracle(scene);
    const std::vector<Ray> rays = hard_rays(scene, pose, 6000);
    std::vector<std::optional<Hit>> hits(rays.size());
    caster.closest(rays, hits);
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto& [origin, direction, min_m, max_m] = rays[i];
      const auto expected = oracle.closest(rays[i]);
      found += expected.has_value();
      ASSERT_TRUE(same(caster.closest(origin, direction, min_m, max_m), expected)) << i;
      ASSERT_TRUE(same(hits[i], expected)) << i << " in its packet";
    }
    EXPECT_GT(found, rays.size() / 3);
    EXPECT_LT(found, rays.size());
  }
}

TEST(ReferenceTracer, AgreesAboutWhatIsInTheWay) {
  for (const auto& [pose, with_shapes] : cases()) {
    const Scene scene = hard_scene(pose, with_shapes);
    const RayCaster caster(scene);
    const ReferenceTracer oracle(scene);
    const std::vector<Ray> rays = hard_rays(scene, pose, 4000);
    const Eigen::Vector3d lamp = pose * Eigen::Vector3d(0.2, 0.1, -0.4);
    std::vector<std::optional<Hit>> hits(rays.size());
    std::vector<Eigen::Vector3d> from;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if ((hits[i] = oracle.closest(rays[i]))) hits[i] = facing(*hits[i], rays[i].direction);
      from.push_back(hits[i] ? caster.leave(*hits[i], -rays[i].direction) : rays[i].origin);
    }
    const std::unique_ptr<bool[]> dark(new bool[rays.size()]), blocked(new bool[rays.size()]);
    caster.occluded(hits, lamp, {dark.get(), rays.size()});
    caster.blocked(from, lamp, {blocked.get(), rays.size()});
    std::size_t free = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool expected = oracle.blocked(from[i], lamp);
      free += !expected;
      ASSERT_EQ(caster.blocked(from[i], lamp), expected) << i;
      ASSERT_EQ(blocked[i], expected) << i << " in its packet";
      ASSERT_EQ(dark[i], !hits[i] || caster.occluded(*hits[i], lamp)) << i;
    }
    EXPECT_GT(free, rays.size() / 20);
    EXPECT_LT(free, rays.size() - rays.size() / 20);
  }
}

// Detail of 0.1 mm, 1e6 m from the world's origin and 10 m from the middle of its scene.
TEST(ReferenceTracer, AgreesAboutFineDetailFarAway) {
  const Pose pose = at(1e6, 1e6, 0);
  Mesh fine = bumpy_ball(14, 20);
  for (auto& v : fine.vertices) v = 1e-4 * v + Eigen::Vector3d(10, 0, 0);
  const Mesh wall{{{-10, -5, -5}, {-10, 5, -5}, {-10, 0, 5}}, {{0, 1, 2}}};
  const Scene scene = scene_of({fine, wall}, pose);
  const RayCaster caster(scene);
  const ReferenceTracer oracle(scene);
  int hits = 0;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    RandomStream random(23, 0, i);
    const Eigen::Vector3d target = fine.vertices[random.bits32() % fine.vertices.size()];
    const double distance_m = std::pow(10, -4 + 5 * random.uniform());
    const Eigen::Vector3d origin = pose * (target + distance_m * random_vector(random));
    const Ray ray{origin, (pose * target - origin).normalized()};
    const auto expected = oracle.closest(ray);
    hits += expected.has_value();
    ASSERT_TRUE(same(caster.closest(ray.origin, ray.direction), expected)) << i;
  }
  EXPECT_GT(hits, 2000);
}

}  // namespace
}  // namespace scan::synth
