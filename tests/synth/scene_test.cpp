// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scene.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "libscan/core/random.h"
#include "synth/medium/diffusion.h"
#include "tests/synth/one_object.h"

namespace scan::synth {
namespace {

TEST(Scene, NamesWhatIsWrong) {
  EXPECT_EQ(complaint_of(one_object()), "");
  Scene scene = one_object();
  scene.materials[0].bsdf = Lambert{1.5};
  EXPECT_NE(complaint_of(scene).find("materials/clay/albedo is 1.5"), std::string::npos);
  scene = one_object(CheckerTexture{-1, 0.5});
  EXPECT_NE(complaint_of(scene).find("clay/texture/period_m"), std::string::npos);
  scene = one_object(NoiseTexture{0.01, 0, 0.5});
  EXPECT_NE(complaint_of(scene).find("octaves"), std::string::npos);
  scene = one_object();
  scene.objects[0].material = 1;
  EXPECT_NE(complaint_of(scene).find("objects/ball/material is 1"), std::string::npos);
  scene = one_object();
  scene.objects[0].world_from_object.linear() *= 1.01;
  EXPECT_NE(complaint_of(scene).find("no rigid motion"), std::string::npos);
  scene = one_object();
  scene.objects[0].geometry = Shape{SphereShape{-1}};
  EXPECT_NE(complaint_of(scene).find("objects/ball: sphere"), std::string::npos);
  scene.objects[0].geometry = Mesh{};
  EXPECT_NE(complaint_of(scene).find("no triangles"), std::string::npos);
}

TEST(Scene, NamesWhatIsWrongWithAMedium) {
  Scene scene = one_object();
  scene.medium = Medium{.absorption_per_m = -1};
  EXPECT_NE(complaint_of(scene).find("scene/medium/absorption_per_m: -1"), std::string::npos);
  scene = one_object();
  scene.materials[0].interior = Medium{};
  scene.materials[0].bsdf = Dielectric{1.4};
  EXPECT_EQ(complaint_of(scene), "");
  scene.materials[0].interior->phase = HenyeyGreenstein{-1};
  EXPECT_NE(complaint_of(scene).find("clay/interior/phase/mean_cosine: -1"), std::string::npos);
}

// A ball of clay, one of clear glass, one of tinted glass, one of marble, in fog under a lamp.
Scene scene_of_all_kinds() {
  Scene scene = one_object();
  scene.materials.push_back({.name = "glass", .bsdf = Dielectric{1.5}});
  scene.materials.push_back(
      {.name = "tinted", .bsdf = Dielectric{1.5}, .interior = Medium{.absorption_per_m = 3}});
  scene.materials.push_back({.name = "marble",
                             .bsdf = Dielectric{1.4, 0.2},
                             .interior = Medium{.absorption_per_m = 1, .scattering_per_m = 2000}});
  for (int i = 1; i < 4; ++i) {
    scene.objects.push_back(scene.objects.front());
    scene.objects.back().name = scene.materials[i].name;
    scene.objects.back().material = i;
  }
  scene.medium = fog(100, 0.7, 0.9);
  scene.lights.push_back(PointLight{.position_m = {0, 0, 1}});
  return scene;
}

TEST(SimplifiedScene, IsTheSceneItselfWithAllEffects) {
  EXPECT_EQ(complaint_of(scene_of_all_kinds()), "");
  const Scene all = simplified(scene_of_all_kinds(), EffectSet::all());
  EXPECT_EQ(all.objects.size(), 4u);
  EXPECT_EQ(all.lights.size(), 1u);
  EXPECT_TRUE(all.medium);
  EXPECT_EQ(all.materials[3].interior->scattering_per_m, 2000);
  EXPECT_EQ(std::get<Dielectric>(all.materials[3].bsdf).roughness, 0.2);
}

TEST(SimplifiedScene, MakesTranslucentBodiesLambertOfEqualAlbedo) {
  const Scene full = scene_of_all_kinds();
  const Scene kept = simplified(full, EffectSet::all().without(Effect::subsurface));
  ASSERT_EQ(kept.objects.size(), 4u);
  EXPECT_EQ(std::get<Lambert>(kept.materials[3].bsdf).albedo,
            diffuse_albedo(*full.materials[3].interior, 1.4));
  EXPECT_FALSE(kept.materials[3].interior);
  EXPECT_EQ(kept.materials[2].interior->absorption_per_m, 3) << "tinted glass is refraction's";
  EXPECT_TRUE(std::holds_alternative<Dielectric>(kept.materials[2].bsdf));
  EXPECT_EQ(std::get<Lambert>(kept.materials[0].bsdf).albedo, 0.6);
  EXPECT_EQ(complaint_of(kept), "");
}

TEST(SimplifiedScene, LeavesOutClearBodiesWithoutRefraction) {
  const Scene kept = simplified(scene_of_all_kinds(), EffectSet::all().without(Effect::refraction));
  ASSERT_EQ(kept.objects.size(), 2u);
  EXPECT_EQ(kept.objects[0].name, "ball");
  EXPECT_EQ(kept.objects[1].name, "marble");
  EXPECT_TRUE(kept.materials[kept.objects[1].material].interior);
}

TEST(SimplifiedScene, StandsInVacuumInTheDarkWithoutEffects) {
  const Scene kept = simplified(scene_of_all_kinds(), {});
  EXPECT_FALSE(kept.medium);
  EXPECT_TRUE(kept.lights.empty());
  ASSERT_EQ(kept.objects.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<Lambert>(kept.materials[kept.objects[1].material].bsdf));
}

TEST(SimplifiedScene, GivesDensityGridsTheirMajorants) {
  Scene scene = scene_of_all_kinds();
  const DensityGrid puff{{Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()},
                         Eigen::Vector3i(1, 1, 2),
                         {0.25f, 0.5f},
                         {}};
  scene.medium->density = puff;
  scene.materials[3].interior->density = puff;
  const Scene kept = simplified(scene, EffectSet::all());
  const std::vector<float> majorants = {0.5f};
  EXPECT_EQ(std::get<DensityGrid>(kept.medium->density).majorants, majorants);
  EXPECT_EQ(std::get<DensityGrid>(kept.materials[3].interior->density).majorants, majorants);
}

TEST(Scene, GivesItsTrueSurfaceInTheWorld) {
  Scene scene = one_object();
  const Pose pose = exp((Vector6() << 0.1, 0.2, 0.3, 1, 2, 3).finished());
  scene.objects[0].world_from_object = pose;
  scene.objects.push_back({"sheet", pose, Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, 0});
  const TrueSurface surface = true_surface(scene);
  ASSERT_EQ(surface.shapes.size(), 1u);
  ASSERT_EQ(surface.meshes.size(), 1u);
  EXPECT_NEAR(field(surface.shapes[0], pose * Eigen::Vector3d(0, 0, 0.3)).value_m, 0.2, 1e-15);
  EXPECT_NEAR((surface.meshes[0].vertices[1] - pose * Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-15);
}

TEST(Scene, RefusesMaterialsThatCannotBe) {
  Scene scene = one_object(NoiseTexture{});
  scene.materials[0].bsdf = Conductor{};
  EXPECT_NE(complaint_of(scene).find("materials/clay/texture multiplies"), std::string::npos);
  scene.materials[0].bsdf = Dielectric{};
  EXPECT_NE(complaint_of(scene).find("materials/clay/texture multiplies"), std::string::npos);
  scene.materials[0].bsdf = Plastic{};
  EXPECT_EQ(complaint_of(scene), "");
  scene.materials[0].interior = Medium{};
  EXPECT_NE(complaint_of(scene).find("materials/clay/interior lies"), std::string::npos);
  scene = one_object();
  scene.materials[0].bsdf = Dielectric{};
  scene.materials[0].interior = Medium{};
  EXPECT_EQ(complaint_of(scene), "");
  scene.materials[0].bsdf = Dielectric{0.5};
  EXPECT_NE(complaint_of(scene).find("materials/clay/index is 0.5"), std::string::npos);
  scene = one_object(ImageTexture{});
  EXPECT_NE(complaint_of(scene).find("clay/texture/image has no pixels"), std::string::npos);
  scene = one_object(ImageTexture{Image<float>(1, 1, 1.5f), 0.1});
  EXPECT_NE(complaint_of(scene).find("clay/texture/image is 1.5"), std::string::npos);
  scene = one_object(ImageTexture{Image<float>(1, 1, 0.5f), 0});
  EXPECT_NE(complaint_of(scene).find("clay/texture/width_m is 0"), std::string::npos);
}

}  // namespace
}  // namespace scan::synth
