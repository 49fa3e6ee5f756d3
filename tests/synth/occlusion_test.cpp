// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "synth/ray_caster.h"
#include "tests/synth/ray_scenes.h"

namespace scan::synth {
namespace {

// R6: on a convex body every light in front of the surface is seen, however small or large the
// body.
TEST(Occlusion, HasNoAcneOnSpheresOfAnySize) {
  for (const double radius : {1e-6, 1e-3, 1.0, 1e6}) {
    const RayCaster caster(scene_of({Shape{SphereShape{radius}}}, at(3 * radius, 0, -radius)));
    const Eigen::Vector3d centre(3 * radius, 0, -radius);
    int hidden = 0, lit = 0;
    for (std::uint64_t i = 0; i < 20000; ++i) {
      RandomStream random(7, 0, i);
      const Eigen::Vector3d eye = centre + 3 * radius * random_vector(random).normalized();
      const Eigen::Vector3d aim = centre + 0.5 * radius * random_vector(random);
      const auto hit = caster.closest(eye, (aim - eye).normalized());
      if (!hit) continue;
      const Eigen::Vector3d light = centre + 5 * radius * random_vector(random).normalized();
      const double cosine = hit->normal.dot((light - hit->point).normalized());
      if (std::abs(cosine) < 1e-7) continue;  // the horizon itself, to the rounding of the hit
      (cosine > 0 ? lit : hidden) += 1;
      ASSERT_EQ(caster.occluded(*hit, light), cosine < 0) << radius << " " << i << " " << cosine;
    }
    EXPECT_GT(hidden, 1000);
    EXPECT_GT(lit, 1000);
  }
}

TEST(Occlusion, HasNoAcneOnAMeshOrABlend) {
  const Shape blend = bud();
  const RayCaster caster(scene_of({blend}));
  for (std::uint64_t i = 0; i < 3000; ++i) {
    RandomStream random(8, 0, i);
    const Eigen::Vector3d eye = 0.3 * random_vector(random).normalized();
    const auto hit = caster.closest(eye, (0.02 * random_vector(random) - eye).normalized());
    if (!hit || hit->normal.dot(eye - hit->point) < 1e-6) continue;
    EXPECT_FALSE(caster.occluded(*hit, eye)) << "what the eye sees is lit by a light in the eye";
  }
  const Mesh mesh = bumpy_ball(40, 80);
  const RayCaster of_mesh(scene_of({mesh}));
  for (std::uint64_t i = 0; i < 20000; ++i) {
    RandomStream random(9, 0, i);
    const Eigen::Vector3d eye = 3 * random_vector(random).normalized();
    const auto hit = of_mesh.closest(eye, (0.6 * random_vector(random) - eye).normalized());
    if (!hit || hit->normal.dot(eye - hit->point) < 1e-6) continue;
    ASSERT_FALSE(of_mesh.occluded(*hit, eye)) << i;
  }
}

TEST(Occlusion, SeesWhatStandsBetweenAndOnlyThat) {
  Scene scene = scene_of({Shape{PlaneShape{}}, Shape{SphereShape{0.5}}});
  scene.objects[1].world_from_object = at(0, 0, 2);
  const RayCaster caster(scene);
  const auto floor = caster.closest({0.2, 0, 1}, {0, 0, -1});
  ASSERT_TRUE(floor);
  EXPECT_TRUE(caster.occluded(*floor, {0.2, 0, 5}));
  EXPECT_FALSE(caster.occluded(*floor, {0.2, 0, 1})) << "the sphere stands behind the light";
  EXPECT_FALSE(caster.occluded(*floor, {4, 0, 1}));
  EXPECT_TRUE(caster.occluded(*floor, {4, 0, -1})) << "the light is behind the surface";
  EXPECT_TRUE(caster.occluded(*floor, {4, 0, 0})) << "and in its plane";
}

// Between two points of one convex body's surface nothing stands, seen from inside; from outside
// the body itself does.
TEST(Occlusion, LeavesBothSurfacesOfASegmentOutOfAccount) {
  const RayCaster caster(scene_of({bumpy_ball(40, 80), Shape{SphereShape{0.3}}}, at(7, 5, -3)));
  const Eigen::Vector3d centre(7, 5, -3);
  const auto surface_hit = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
    return *caster.closest(from, direction);
  };
  for (std::uint64_t i = 0; i < 5000; ++i) {
    RandomStream random(12, 0, i);
    const Eigen::Vector3d up = random_vector(random).normalized();
    const Hit floor = surface_hit(centre, up);      // on the sphere, from inside
    const Hit roof = surface_hit(floor.point, up);  // on the mesh above it
    const Eigen::Vector3d start = caster.leave(floor, up), end = caster.leave(roof, -up);
    EXPECT_GT((start - floor.point).dot(floor.normal), 0);
    EXPECT_LT((end - roof.point).dot(roof.normal), 0);
    ASSERT_FALSE(caster.blocked(start, end)) << i;
    ASSERT_FALSE(caster.blocked(end, start)) << i;
    ASSERT_TRUE(caster.blocked(caster.leave(floor, -up), end)) << "from inside the sphere";
    ASSERT_TRUE(caster.blocked(start, caster.leave(roof, up))) << "to outside the mesh";
    EXPECT_FALSE(caster.blocked(centre, caster.leave(floor, -up)));
  }
  EXPECT_FALSE(caster.blocked(centre, centre));
}

}  // namespace
}  // namespace scan::synth
