// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/connection.h"

#include <gtest/gtest.h>

#include "synth/bsdf/fresnel.h"
#include "tests/synth/smooth_scenes.h"

namespace scan::synth {
namespace {

Scene with_plate() {
  Scene scene;
  scene.materials = {plain(0.5)};
  scene.objects = {plane_at(2), plate(1, -0.1, 0.1)};
  return scene;
}

TEST(Connector, FindsTheStraightWay) {
  const RayCaster caster(with_plate());
  const Connector connector(caster, 4);
  EXPECT_TRUE(connector.straight_only());
  const Eigen::Vector3d light(0.5, 0, 0);
  const auto hit = caster.closest({1, 0, 0}, Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(hit);
  std::vector<Connection> ways(3);  // what is in it goes away
  connector.connect(*hit, light, ways);
  ASSERT_EQ(ways.size(), 1u);
  const Eigen::Vector3d way = light - hit->point;
  EXPECT_LT((ways[0].arriving - way.normalized()).norm(), 1e-15);
  EXPECT_EQ(ways[0].emitted, -ways[0].arriving);
  EXPECT_EQ(ways[0].length_m, way.norm());
  EXPECT_EQ(ways[0].optical_m, way.norm());
  EXPECT_EQ(ways[0].throughput, 1);
  EXPECT_EQ(ways[0].spread, 1);
  EXPECT_EQ(ways[0].bounces, 0);
}

TEST(Connector, FindsNoWayThroughAWall) {
  const RayCaster caster(with_plate());
  const Connector connector(caster, 4);
  const auto hit = caster.closest({0.15, 0, 1.5}, Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(hit);
  std::vector<Connection> ways(1);
  connector.connect(*hit, Eigen::Vector3d(-0.1, 0, 0), ways);  // passes z = 1 at x = 0.025
  EXPECT_TRUE(ways.empty());
  connector.connect(*hit, Eigen::Vector3d(1, 0, 3), ways);  // behind the surface
  EXPECT_TRUE(ways.empty());
}

TEST(Connector, ConnectsPointsInFreeSpace) {
  const RayCaster caster(with_plate());
  const Connector connector(caster, 4);
  std::vector<Connection> ways;
  connector.connect(Eigen::Vector3d(0, 0, 1.5), Eigen::Vector3d(0, 0, 0.5), ways);
  EXPECT_TRUE(ways.empty());
  connector.connect(Eigen::Vector3d(0.5, 0, 1.5), Eigen::Vector3d(0.5, 0, 0.5), ways);
  ASSERT_EQ(ways.size(), 1u);
  EXPECT_EQ(ways[0].length_m, 1);
}

// As if from the mirrored light.
TEST(PlaneMirror, ShowsTheMirroredLight) {
  Scene scene;
  scene.materials = {mirror_material()};
  const Eigen::Matrix3d turn = turn_about_y(0.3);
  scene.objects = {placed(PlaneShape{}, 0, {0.2, 0.1, -0.4}, turn)};
  const RayCaster caster(scene);
  const Connector connector(caster, 4);
  const Eigen::Vector3d at(0.5, 0.3, 0.8), light(-0.4, 0.2, 1.1);
  std::vector<Connection> ways;
  connector.connect(at, light, ways);
  ASSERT_EQ(ways.size(), 2u);
  EXPECT_EQ(ways[0].bounces, 0);
  const Connection& way = ways[1];
  const Eigen::Vector3d normal = turn.col(2);
  const double height_m = normal.dot(light - Eigen::Vector3d(0.2, 0.1, -0.4));
  const Eigen::Vector3d image = light - 2 * height_m * normal;
  EXPECT_EQ(way.bounces, 1);
  EXPECT_LT((way.arriving - (image - at).normalized()).norm(), 1e-12);
  EXPECT_NEAR(way.length_m, (image - at).norm(), 1e-13);
  EXPECT_EQ(way.optical_m, way.length_m);
  EXPECT_NEAR(way.spread, 1, 1e-12);
  const double cosine = -way.arriving.dot(normal);
  EXPECT_NEAR(way.throughput, fresnel_conductor(cosine, 0.2, 6), 1e-13);
  expect_stationary(scene, {0}, at, light, way, {1, 1});
}

// Two mirrors at a right angle: three images. The last is the light turned half about the edge.
TEST(CornerOfMirrors, ShowsThreeImages) {
  Scene scene;
  scene.materials = {mirror_material()};
  scene.objects = {placed(BoxShape{{0.02, 4, 4}}, 0, {-0.01, 0, 0}),
                   placed(BoxShape{{4, 4, 0.02}}, 0, {0, 0, -0.01})};
  const RayCaster caster(scene);
  const Connector connector(caster, 4);
  const Eigen::Vector3d at(0.5, 0.3, 0.8), light(0.4, -0.2, 0.3);
  std::vector<Connection> ways;
  connector.connect(at, light, ways);
  ASSERT_EQ(ways.size(), 4u);
  const std::vector<Eigen::Vector3d> images = {
      light, {-0.4, -0.2, 0.3}, {0.4, -0.2, -0.3}, {-0.4, -0.2, -0.3}};
  double shares = 1;
  for (const Eigen::Vector3d& image : images) {
    bool found = false;
    for (const Connection& way : ways)
      if ((way.arriving - (image - at).normalized()).norm() < 1e-12) {
        found = true;
        EXPECT_NEAR(way.optical_m, (image - at).norm(), 1e-13);
        EXPECT_NEAR(way.spread, 1, 1e-12);
        shares = way.throughput;
      }
    EXPECT_TRUE(found) << image.transpose();
  }
  const Eigen::Vector3d way = (images[3] - at).normalized();
  EXPECT_NEAR(shares, fresnel_conductor(-way.x(), 0.2, 6) * fresnel_conductor(-way.z(), 0.2, 6),
              1e-13);
  const Connector once(caster, 1);
  once.connect(at, light, ways);
  EXPECT_EQ(ways.size(), 3u);
  const Connector never(caster, 0);
  EXPECT_TRUE(never.straight_only());
  never.connect(at, light, ways);
  EXPECT_EQ(ways.size(), 1u);
}

// What hangs before the mirror blocks the way over it.
TEST(PlaneMirror, BlockedBeforeAndBehindTheBend) {
  for (const double x : {-0.25, 0.25}) {
    Scene scene;
    scene.materials = {mirror_material(), plain(0.5)};
    scene.objects = {placed(PlaneShape{}, 0, {0, 0, 0}), placed(SphereShape{0.1}, 1, {x, 0, 0.5})};
    const RayCaster caster(scene);
    const Connector connector(caster, 4);
    std::vector<Connection> ways;
    connector.connect(Eigen::Vector3d(0.5, 0, 1), Eigen::Vector3d(-0.5, 0, 1), ways);
    ASSERT_EQ(ways.size(), 1u);
    EXPECT_EQ(ways[0].bounces, 0);
  }
}

// A surface point next to a mirror: what comes over it must come from the side that is lit.
TEST(PlaneMirror, LightsWallsThatFaceIt) {
  Scene scene;
  scene.materials = {mirror_material(), plain(0.5)};
  scene.objects = {placed(PlaneShape{}, 0, {0, 0, 0}), placed(BoxShape{{1, 1, 0.1}}, 1, {0, 0, 1})};
  const RayCaster caster(scene);
  const Connector connector(caster, 4);
  std::vector<Connection> ways;
  const auto below = caster.closest({0.1, 0, 0.5}, Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(below);
  connector.connect(*below, Eigen::Vector3d(-0.1, 0, 0.6), ways);
  EXPECT_EQ(ways.size(), 2u);
  const auto above = caster.closest({0.1, 0, 1.5}, -Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(above);
  connector.connect(*above, Eigen::Vector3d(-0.1, 0, 1.6), ways);
  EXPECT_EQ(ways.size(), 1u);
}

// Plastic's smooth coat is a mirror of the coat's reflectance.
TEST(SmoothCoat, ReflectsByFresnel) {
  Scene scene;
  scene.materials = {{.name = "varnish", .bsdf = Plastic{.index = 1.45, .roughness = 0}}};
  scene.objects = {placed(PlaneShape{}, 0, {0, 0, 0})};
  const RayCaster caster(scene);
  const Connector connector(caster, 4);
  std::vector<Connection> ways;
  connector.connect(Eigen::Vector3d(0.5, 0, 1), Eigen::Vector3d(-0.5, 0, 1), ways);
  ASSERT_EQ(ways.size(), 2u);
  EXPECT_NEAR(ways[1].throughput, fresnel_dielectric(2 / std::sqrt(5.0), 1.45), 1e-13);
  const auto on_it = caster.closest({0, 0, 1}, -Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(on_it);
  connector.connect(*on_it, Eigen::Vector3d(-0.5, 0, 1), ways);
  EXPECT_EQ(ways.size(), 1u);
}

// Far from the world's origin coordinates lose digits, ways do not get lost: 1e-10 m of rounding at
// 1e6 m.
TEST(Connector, WorksFarFromTheOrigin) {
  Scene scene;
  const Eigen::Vector3d far(1e6, -2e6, 5e5);
  scene.materials = {mirror_material(), glass_material()};
  scene.objects = {placed(BoxShape{{4, 4, 0.02}}, 0, far + Eigen::Vector3d(0, 0, -0.01)),
                   placed(BoxShape{{1, 1, 0.01}}, 1, far + Eigen::Vector3d(0, 0, 1))};
  const RayCaster caster(scene);
  const Connector connector(caster, 8);
  std::vector<Connection> ways;
  connector.connect(Eigen::Vector3d(far + Eigen::Vector3d(0.2, 0.1, 0.5)),
                    Eigen::Vector3d(far + Eigen::Vector3d(-0.1, 0.1, 1.6)), ways);
  ASSERT_FALSE(ways.empty());
  EXPECT_EQ(ways[0].bounces, 2);
  EXPECT_EQ(with_bounces(ways, 3).size(), 1u);  // over the mirror, then through the pane
}

TEST(Connector, RefusesGlassOfUnevenDensity) {
  Scene scene;
  scene.materials = {glass_material()};
  scene.materials[0].interior = Medium{.absorption_per_m = 1, .density = DensityGrid{}};
  scene.objects = {placed(SphereShape{0.1}, 0, Eigen::Vector3d::Zero())};
  // not the caster's check: whether it lets the scene pass is the scene's business
  EXPECT_THROW(
      {
        const RayCaster caster(scene);
        const Connector connector(caster, 1);
      },
      Error);
}

TEST(Connector, GivesTheSameOnAnyThread) {
  Scene scene;
  scene.materials = {mirror_material(), glass_material(), plain(0.5)};
  scene.objects = {placed(SphereShape{0.2}, 0, {0.4, 0, 1}),
                   placed(SphereShape{0.1}, 1, {0, 0, 0.8}), plane_at(2, 0, 2)};
  const RayCaster caster(scene);
  const Connector connector(caster, 8);
  expect_same_for_any_thread_count([&] {
    std::vector<double> sums(200, 0.0);
    parallel_for(sums.size(), [&](std::size_t i) {
      std::vector<Connection> ways;
      const Eigen::Vector3d at(-0.2 + 0.002 * static_cast<double>(i), 0.03, 1.99);
      connector.connect(at, Eigen::Vector3d(0.1, 0, 0), ways);
      for (const Connection& way : ways) sums[i] += way.throughput * way.spread + way.optical_m;
    });
    return sums;
  });
}

}  // namespace
}  // namespace scan::synth
