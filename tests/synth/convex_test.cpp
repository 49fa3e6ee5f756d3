// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/convex.h"

#include <gtest/gtest.h>

#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

Scene ball() {
  return {.objects = {sphere_at({0, 0, 1}, 0.3)}, .materials = {plain(0.5)}};
}

TEST(LightMeetsOnce, ABallOrAPlaneSeenFromOutside) {
  EXPECT_TRUE(light_meets_once(ball(), {0, 0, 0}));
  Scene plane = ball();
  plane.objects = {plane_at(1)};
  EXPECT_TRUE(light_meets_once(plane, {0, 0, 0}));
}

TEST(LightMeetsOnce, NotInsideABall) {
  EXPECT_FALSE(light_meets_once(ball(), {0, 0, 1.1}));
}

TEST(LightMeetsOnce, NotWithASecondThing) {
  Scene scene = ball();
  scene.objects.push_back(plane_at(2));
  EXPECT_FALSE(light_meets_once(scene, {0, 0, 0}));
  scene = ball();
  scene.lights.push_back(PointLight{});
  EXPECT_FALSE(light_meets_once(scene, {0, 0, 0}));
  scene = ball();
  scene.medium = Medium{};
  EXPECT_FALSE(light_meets_once(scene, {0, 0, 0}));
  scene = ball();
  scene.materials[0].bsdf = Dielectric{};
  EXPECT_FALSE(light_meets_once(scene, {0, 0, 0}));
}

TEST(LightMeetsOnce, NotOnAShapeWithAHole) {
  Scene scene = ball();
  scene.objects[0].geometry = Shape(TorusShape{0.3, 0.1});
  EXPECT_FALSE(light_meets_once(scene, {0, 0, 0}));
}

}  // namespace
}  // namespace scan::synth
