// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/shooting.h"

#include <gtest/gtest.h>

#include "tests/synth/smooth_scenes.h"

namespace scan::synth {
namespace {

TEST(Turned, ObeysSnellAndReflection) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    RandomStream random(4, 0, i);
    Eigen::Vector3d direction, normal;
    for (int axis = 0; axis < 3; ++axis) direction(axis) = random.normal();
    for (int axis = 0; axis < 3; ++axis) normal(axis) = random.normal();
    direction.normalize();
    normal.normalize();
    if (direction.dot(normal) > 0) normal = -normal;
    const double index = 0.5 + random.uniform() * 1.5;
    const auto mirrored = turned(direction, normal, true, index);
    ASSERT_TRUE(mirrored);
    EXPECT_NEAR(mirrored->dot(normal), -direction.dot(normal), 1e-15);
    EXPECT_LT((mirrored->cross(normal) - direction.cross(normal)).norm(), 1e-15);
    const auto refracted = turned(direction, normal, false, index);
    ASSERT_EQ(refracted.has_value(), direction.cross(normal).norm() < index);
    if (!refracted) continue;
    // n_i sin_i = n_t sin_t in one plane; onwards
    EXPECT_LT((index * refracted->cross(normal) - direction.cross(normal)).norm(), 1e-14);
    EXPECT_LT(refracted->dot(normal), 0);
    EXPECT_NEAR(refracted->norm(), 1, 1e-15);
  }
}

// The gradient by central differences of where the ray passes the target's plane across it. Step
// 1e-6 rad: error h^2 times third derivatives over the miss' scale, rounding 1e-16 / h; gradients
// of curved shapes by differences of the field add 1e-9.
void expect_gradient(const Shape& shape, const Chain& chain, const Eigen::Vector3d& direction) {
  Scene scene;
  scene.materials = {glass_material()};
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  scene.objects = {placed(shape, 0, {0.1, 0.2, 0.3}, turn)};
  const SmoothSurfaces surfaces(scene);
  const Eigen::Vector3d start = Eigen::Vector3d(-0.02, 0.05, -1) - surfaces.origin;
  const Eigen::Vector3d target = Eigen::Vector3d(0.3, 0.2, 1.5) - surfaces.origin;
  const auto shot = shoot(surfaces, chain, start, direction, target);
  ASSERT_TRUE(shot);
  const Eigen::Vector3d last = shot->directions[chain.size];
  const Eigen::Vector3d passing = target - shot->miss;
  const auto place = [&](const Eigen::Vector3d& first) {
    const auto moved = shoot(surfaces, chain, start, first.normalized(), target);
    EXPECT_TRUE(moved);
    // on the plane through `passing` across the unmoved ray
    const Eigen::Vector3d d = moved->directions[chain.size], p = moved->points[chain.size - 1];
    return Eigen::Vector3d(p + last.dot(passing - p) / last.dot(d) * d);
  };
  const double step = 1e-6;
  Eigen::Matrix<double, 3, 2> change;
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector3d side = step * shot->across_first.col(k);
    change.col(k) = (place(direction + side) - place(direction - side)) / (2 * step);
  }
  // The frame across the last direction is not told: compare lengths and the angle between.
  const Eigen::Matrix2d truth = change.transpose() * change;
  const Eigen::Matrix2d found = shot->gradient.transpose() * shot->gradient;
  EXPECT_LT((truth - found).norm(), 1e-6 * truth.norm());
}

Chain over(const std::vector<Turn>& turns) {
  Chain chain;
  for (const Turn& turn : turns) chain.add(turn);
  return chain;
}

TEST(Shoot, GradientIsTheDerivative) {
  const Eigen::Vector3d towards = Eigen::Vector3d(0.1, 0.2, 1.3).normalized();
  CombinedShape blended{.blend_m = 0.05};
  blended.parts = {{make_pose(Eigen::Matrix3d::Identity(), {0, 0, 0.1}), SphereShape{0.2}},
                   {make_pose(Eigen::Matrix3d::Identity(), {0, 0, -0.1}), SphereShape{0.25}}};
  const Turn in{.sheet = 0}, out{.sheet = 0, .from_inside = true},
      back{.sheet = 0, .reflects = true, .from_inside = true}, off{.sheet = 0, .reflects = true};
  for (const Shape& shape : {Shape(SphereShape{0.3}), Shape(blended)}) {
    expect_gradient(shape, over({off}), towards);
    expect_gradient(shape, over({in, out}), towards);
    expect_gradient(shape, over({in, back, out}), towards);
  }
  // rays that meet the tube, the rod's side (sheet 2 after its two ends) and the rounded corner
  expect_gradient(TorusShape{0.25, 0.1}, over({off}),
                  Eigen::Vector3d(0.35, 0.25, 1.3).normalized());
  expect_gradient(CylinderShape{0.2, 2}, over({{.sheet = 2}, {.sheet = 2, .from_inside = true}}),
                  towards);
  expect_gradient(BoxShape{{0.4, 0.4, 0.4}, 0.19}, over({off}), towards);
}

TEST(Solve, HitsTheTarget) {
  Scene scene;
  scene.materials = {glass_material()};
  scene.objects = {placed(SphereShape{0.3}, 0, {0.1, 0.2, 0.3})};
  const SmoothSurfaces surfaces(scene);
  const Chain chain = over({{.sheet = 0}, {.sheet = 0, .from_inside = true}});
  const Eigen::Vector3d start = Eigen::Vector3d(-0.02, 0.05, -1) - surfaces.origin;
  const Eigen::Vector3d target = Eigen::Vector3d(0.3, 0.2, 1.5) - surfaces.origin;
  const auto shot = solve(surfaces, chain, start, -start.normalized(), target);
  ASSERT_TRUE(shot);
  EXPECT_LT(shot->miss.norm(), 1e-12 * (target - start).norm());
  EXPECT_GT(shot->last_m, 0);
}

}  // namespace
}  // namespace scan::synth
