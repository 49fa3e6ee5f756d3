// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/surroundings.h"

#include <gtest/gtest.h>

#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

Scene kinds() {
  Scene scene;
  scene.materials = {
      plain(0.5),
      {.name = "mirror", .bsdf = Conductor{.roughness = 0}, .texture = {}, .interior = {}},
      {.name = "metal", .bsdf = Conductor{.roughness = 0.1}, .texture = {}, .interior = {}},
      {.name = "tinted glass",
       .bsdf = Dielectric{.index = 1.5},
       .texture = {},
       .interior = Medium{.absorption_per_m = 3}},
      {.name = "wax",
       .bsdf = Dielectric{.index = 1.4, .roughness = 0.3},
       .texture = {},
       .interior = Medium{.scattering_per_m = 100}},
      {.name = "paint",
       .bsdf = Plastic{.roughness = 0},
       .texture = CheckerTexture{},
       .interior = {}}};
  for (int i = 0; i < 6; ++i) scene.objects.push_back(sphere_at({0, 0, 2.0 * i}, 0.5, i));
  return scene;
}

TEST(ObjectOptics, TellsWhatASurfaceDoesWithLight) {
  const Scene scene = kinds();
  const auto optics = optics_of(scene);
  const bool smooth[] = {false, true, false, true, false, false};
  const bool delta[] = {false, true, false, true, false, true};
  const bool transmissive[] = {false, false, false, true, true, false};
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(optics[i].is_smooth, smooth[i]) << i;
    EXPECT_EQ(optics[i].has_delta, delta[i]) << i;
    EXPECT_EQ(optics[i].is_transmissive, transmissive[i]) << i;
    EXPECT_EQ(optics[i].is_textured, i == 5) << i;
  }
  EXPECT_EQ(optics[3].index, 1.5);
  EXPECT_EQ(optics[0].index, 1);
  EXPECT_EQ(optics[4].interior, &*scene.materials[4].interior);
  EXPECT_EQ(optics[0].interior, nullptr);
}

TEST(Surroundings, AreTheInnermostBody) {
  const Scene scene = kinds();
  const auto optics = optics_of(scene);
  const Medium outside{.scattering_per_m = 1};
  Surroundings around;
  EXPECT_EQ(around.index(), 1);
  EXPECT_EQ(around.medium(&outside), &outside);
  EXPECT_FALSE(around.in_translucent_body());
  around.enter(optics[3]);
  EXPECT_EQ(around.index(), 1.5);
  EXPECT_EQ(around.medium(&outside), optics[3].interior);
  EXPECT_FALSE(around.in_translucent_body());
  around.enter(optics[4]);
  EXPECT_EQ(around.index(), 1.4);
  EXPECT_TRUE(around.in_translucent_body());
  around.exit(optics[3]);  // bodies that overlap are left in any order
  EXPECT_EQ(around.index(), 1.4);
  around.exit(optics[3]);
  EXPECT_EQ(around.index(), 1.4);
  around.exit(optics[4]);
  EXPECT_FALSE(around.in_body());
}

TEST(Surroundings, KeepCountBeyondFourBodies) {
  const Scene scene = kinds();
  const auto optics = optics_of(scene);
  Surroundings around;
  for (int i = 0; i < 6; ++i) around.enter(optics[i]);
  EXPECT_EQ(around.medium(nullptr), optics[5].interior);
  for (int i = 5; i >= 0; --i) around.exit(optics[i]);
  EXPECT_FALSE(around.in_body());
}

}  // namespace
}  // namespace scan::synth
