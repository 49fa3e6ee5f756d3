// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Ways over curved mirrors against bisection and Coddington's equations.
#include <gtest/gtest.h>

#include <array>

#include "synth/bsdf/fresnel.h"
#include "tests/synth/smooth_scenes.h"

namespace scan::synth {
namespace {

// Angle on the mirror's circle where light from a to b is reflected, between two angles: the ways'
// sum has a zero slope there (Alhazen's problem). Centre at the origin, plane y = 0.
struct Circle {
  double radius_m;
  Eigen::Vector3d a, b;
  Eigen::Vector3d at(double angle) const {
    return radius_m * Eigen::Vector3d(std::cos(angle), 0, std::sin(angle));
  }
  double slope(double angle) const {
    const Eigen::Vector3d along(-std::sin(angle), 0, std::cos(angle));
    return (at(angle) - a).normalized().dot(along) + (at(angle) - b).normalized().dot(along);
  }
};

// Coddington's equations for a sphere of radius R (negative: hollow) at incidence i, light at
// distance s and the point at distance l: the area across the way per solid angle is
// (s + l + 2 s l / (R cos i)) (s + l + 2 s l cos i / R).
double coddington_spread(double s, double l, double radius_m, double cosine) {
  const double area =
      (s + l + 2 * s * l / (radius_m * cosine)) * (s + l + 2 * s * l * cosine / radius_m);
  return (s + l) * (s + l) / std::abs(area);
}

TEST(SphereMirror, SolvesAlhazensProblem) {
  const double r = 0.3;
  Scene scene;
  scene.materials = {mirror_material()};
  scene.objects = {placed(SphereShape{r}, 0, Eigen::Vector3d::Zero())};
  const RayCaster caster(scene);
  const Connector connector(caster, 4);
  for (const Eigen::Vector3d& at : {Eigen::Vector3d(0.5, 0, 0.9), Eigen::Vector3d(-0.1, 0, 0.35),
                                    Eigen::Vector3d(2.5, 0, 0.1)}) {
    const Eigen::Vector3d light(-0.2, 0, 1.1);
    std::vector<Connection> ways;
    connector.connect(at, light, ways);
    ASSERT_EQ(ways.size(), 2u) << at.transpose();
    const Connection& way = ways[1];
    const Circle circle{r, at, light};
    // between the directions of both ends as seen from the centre
    const double angle = bisect(std::atan2(at.z(), at.x()), std::atan2(light.z(), light.x()),
                                [&](double a) { return circle.slope(a); });
    const Eigen::Vector3d bend = circle.at(angle);
    EXPECT_LT((way.bends[0] - bend).norm(), 1e-11);
    expect_stationary(scene, {0}, at, light, way, {1, 1});
    const double cosine = (at - bend).normalized().dot(bend / r);
    EXPECT_NEAR(
        way.spread / coddington_spread((light - bend).norm(), (at - bend).norm(), r, cosine), 1,
        1e-9);
    EXPECT_NEAR(way.throughput, fresnel_conductor(cosine, 0.2, 6), 1e-11);
  }
}

// A convex mirror shows each light once, wherever both stand outside.
TEST(SphereMirror, ShowsEachLightOnce) {
  Scene scene;
  scene.materials = {mirror_material()};
  scene.objects = {placed(SphereShape{0.3}, 0, {0.1, 0.2, 0.3})};
  const RayCaster caster(scene);
  const Connector connector(caster, 1);
  std::vector<Connection> ways;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    RandomStream random(8, 0, i);
    std::array<Eigen::Vector3d, 2> ends;
    for (Eigen::Vector3d& end : ends) {
      for (int axis = 0; axis < 3; ++axis) end(axis) = random.normal();
      end = Eigen::Vector3d(0.1, 0.2, 0.3) +
            end.normalized() * 0.3 / (0.01 + 0.98 * random.uniform());
    }
    connector.connect(ends[0], ends[1], ways);
    const auto over = with_bounces(ways, 1);
    const bool straight = ways.size() > over.size();
    // seen past the mirror: always; from opposite sides: never
    EXPECT_EQ(over.size(), straight ? 1u : 0u) << i;
    for (const Connection& way : over) expect_stationary(scene, {0}, ends[0], ends[1], way, {1, 1});
  }
}

// Neither ball nor facet: starts from samples of the surface, slid along it. A long rod shows each
// light once if both ends are near its middle.
TEST(RodMirror, ShowsEachLightOnce) {
  Scene scene;
  scene.materials = {mirror_material()};
  scene.objects = {placed(CylinderShape{0.3, 8}, 0, Eigen::Vector3d::Zero())};
  const RayCaster caster(scene);
  const Connector connector(caster, 1);
  std::vector<Connection> ways;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    RandomStream random(9, 0, i);
    std::array<Eigen::Vector3d, 2> ends;
    for (Eigen::Vector3d& end : ends) {
      const double angle = 2 * std::numbers::pi * random.uniform();
      const double radius = 0.3 / (0.1 + 0.88 * random.uniform());
      end = {radius * std::cos(angle), radius * std::sin(angle), random.uniform() - 0.5};
    }
    connector.connect(ends[0], ends[1], ways);
    const auto over = with_bounces(ways, 1);
    const bool straight = ways.size() > over.size();
    EXPECT_EQ(over.size(), straight ? 1u : 0u) << i;
    for (const Connection& way : over) expect_stationary(scene, {0}, ends[0], ends[1], way, {1, 1});
  }
}

// A bowl: every zero of the slope on the part of the circle that exists and is seen.
TEST(BowlMirror, ShowsEveryReflection) {
  const double r = 0.5;
  Scene scene;
  scene.materials = {mirror_material()};
  // the half-space below z = 0 without the ball
  CombinedShape bowl{.operation = CombinedShape::Operation::subtract};
  bowl.parts = {{make_pose(Eigen::Matrix3d::Identity(), {0, 0, -0.5}), BoxShape{{1.4, 1.4, 1}}},
                {Pose::Identity(), SphereShape{r}}};
  scene.objects = {placed(bowl, 0, Eigen::Vector3d::Zero())};
  const RayCaster caster(scene);
  const Connector connector(caster, 1);
  for (const Eigen::Vector3d& at : {Eigen::Vector3d(0.2, 0, 0.1), Eigen::Vector3d(0.3, 0, -0.2),
                                    Eigen::Vector3d(0.1, 0, 0.7)}) {
    const Eigen::Vector3d light(-0.15, 0, -0.05);
    const Circle circle{r, at, light};
    std::vector<double> truth;
    const int parts = 1000;
    for (int i = 0; i < parts; ++i) {
      const double a = -std::numbers::pi * i / parts, b = -std::numbers::pi * (i + 1) / parts;
      if ((circle.slope(a) > 0) == (circle.slope(b) > 0)) continue;
      truth.push_back(bisect(a, b, [&](double angle) { return circle.slope(angle); }));
    }
    ASSERT_FALSE(truth.empty());
    std::vector<Connection> ways;
    connector.connect(at, light, ways);
    EXPECT_EQ(with_bounces(ways, 1).size(), truth.size()) << at.transpose();
    for (const double angle : truth) {
      const Eigen::Vector3d bend = circle.at(angle);
      bool found = false;
      for (const Connection& way : with_bounces(ways, 1))
        if ((way.bends[0] - bend).norm() < 1e-9) {
          found = true;
          const double cosine = -(at - bend).normalized().dot(bend / r);
          const double truth_spread =
              coddington_spread((light - bend).norm(), (at - bend).norm(), -r, cosine);
          EXPECT_NEAR(way.spread / truth_spread, 1, 1e-6);
        }
      EXPECT_TRUE(found) << at.transpose() << " angle " << angle;
    }
  }
}

}  // namespace
}  // namespace scan::synth
