// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What descriptions of lights are refused, and how.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "libscan/core/error.h"
#include "synth/scene.h"

namespace scan::synth {
namespace {

std::string complaint_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Light, NamesWhatIsWrong) {
  const auto complaint = [](const Light& light) {
    return complaint_of([&] { check(light, "lights/0"); });
  };
  EXPECT_EQ(complaint(AreaLight{}), "");
  EXPECT_EQ(complaint(Environment{.map = Image<float>(12, 7, 0.1f)}), "");
  const double nan = std::nan("");
  EXPECT_NE(complaint(PointLight{.position_m = {0, nan, 0}}).find("lights/0/position_m"),
            std::string::npos);
  EXPECT_NE(complaint(PointLight{.intensity_w_sr = -1}).find("intensity_w_sr is -1"),
            std::string::npos);
  EXPECT_NE(complaint(AreaLight{.width_m = 0}).find("width_m"), std::string::npos);
  EXPECT_NE(complaint(AreaLight{.height_m = nan}).find("height_m"), std::string::npos);
  EXPECT_NE(complaint(AreaLight{.radiance_w_m2_sr = nan}).find("radiance"), std::string::npos);
  AreaLight stretched;
  stretched.world_from_light.linear() *= 2;
  EXPECT_NE(complaint(stretched).find("lights/0/world_from_light is no rigid motion"),
            std::string::npos);
  Environment broken{.map = Image<float>(12, 7, 0.1f)};
  broken.map(3, 3) = -1;
  EXPECT_NE(complaint(broken).find("lights/0/map is -1"), std::string::npos);
}

TEST(Light, InsideAnOpaqueShapeIsRefused) {
  Scene scene;
  scene.materials = {{.name = "clay"}, {.name = "glass", .bsdf = Dielectric{}}};
  scene.objects = {{.name = "wall", .geometry = Shape(BoxShape{{1, 1, 1}}), .material = 0}};
  scene.lights = {PointLight{.position_m = {0.4, 0, 0}}};
  const auto complaint = [&] { return complaint_of([&] { check(scene); }); };
  EXPECT_NE(complaint().find("position_m lies inside scene/objects/wall"), std::string::npos);
  scene.objects[0].material = 1;
  EXPECT_EQ(complaint(), "");
  scene.objects[0].material = 0;
  scene.lights = {PointLight{.position_m = {0.6, 0, 0}}};
  EXPECT_EQ(complaint(), "");
  scene.lights = {PointLight{.intensity_w_sr = -3}};
  EXPECT_NE(complaint().find("scene/lights/0/intensity_w_sr"), std::string::npos);
}

}  // namespace
}  // namespace scan::synth
