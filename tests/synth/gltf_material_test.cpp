// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/gltf_material.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/error.h"
#include "synth/bsdf/fresnel.h"

namespace scan::synth {
namespace {

const Eigen::Vector3d facing = Eigen::Vector3d::UnitZ();
const LinearRgb rust = {0.4, 0.2, 0.1};

TEST(GltfMaterial, ColourGoesOverThePrimaries) {
  EXPECT_DOUBLE_EQ(colour_at(rust, 611e-9), 0.4);
  EXPECT_DOUBLE_EQ(colour_at(rust, 549e-9), 0.2);
  EXPECT_DOUBLE_EQ(colour_at(rust, 464e-9), 0.1);
  EXPECT_DOUBLE_EQ(colour_at(rust, 580e-9), 0.3);
  EXPECT_DOUBLE_EQ(colour_at(rust, 405e-9), 0.1);
  EXPECT_DOUBLE_EQ(colour_at(rust, 905e-9), 0.4);
}

TEST(GltfMaterial, MetalReflectsItsColourFacingIt) {
  for (const double colour : {0.0, 0.3, 0.9}) {
    GltfMaterial gltf{.name = "m", .base_colour = {colour, colour, colour}, .roughness = 0};
    EXPECT_NEAR(albedo(material_from_gltf(gltf, 650e-9).bsdf, facing), colour, 1e-14);
  }
  const Material rough = material_from_gltf({.name = "m", .roughness = 0.3}, 650e-9);
  EXPECT_DOUBLE_EQ(std::get<Conductor>(rough.bsdf).roughness, 0.09);
  EXPECT_FALSE(rough.interior);
}

TEST(GltfMaterial, CoatedSurfaceShowsItsColourUnderTheCoat) {
  GltfMaterial gltf{.name = "p", .base_colour = rust, .metallic = 0, .roughness = 0};
  for (const double ior : {1.0, 1.3, 1.8}) {
    gltf.ior = ior;
    const double f = fresnel_dielectric(1, ior);
    EXPECT_NEAR(albedo(material_from_gltf(gltf, 611e-9).bsdf, facing), f + (1 - f) * 0.4, 1e-12);
  }
  gltf.roughness = 0.5;
  EXPECT_DOUBLE_EQ(std::get<Plastic>(material_from_gltf(gltf, 611e-9).bsdf).roughness, 0.25);
}

TEST(GltfMaterial, GlassLeavesTheAttenuationColourAfterItsDistance) {
  GltfMaterial gltf{.name = "g",
                    .metallic = 0,
                    .roughness = 0,
                    .ior = 1.45,
                    .transmission = 1,
                    .attenuation_distance_m = 0.02,
                    .attenuation_colour = rust};
  const Material glass = material_from_gltf(gltf, 611e-9);
  EXPECT_EQ(std::get<Dielectric>(glass.bsdf).index, 1.45);
  ASSERT_TRUE(glass.interior);
  EXPECT_NEAR(std::exp(-0.02 * glass.interior->absorption_per_m), 0.4, 1e-14);
  EXPECT_EQ(glass.interior->scattering_per_m, 0);
  EXPECT_TRUE(is_clear(glass));
  gltf.attenuation_colour = {0, 0, 0};
  EXPECT_TRUE(std::isfinite(material_from_gltf(gltf, 611e-9).interior->absorption_per_m));
  gltf.attenuation_distance_m = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(material_from_gltf(gltf, 611e-9).interior);
}

TEST(GltfMaterial, RefusesWhatGltfForbids) {
  const auto complaint = [](const GltfMaterial& gltf) -> std::string {
    try {
      material_from_gltf(gltf, 650e-9);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint({.name = "ok"}), "");
  EXPECT_EQ(complaint({.name = "a", .base_colour = {1, 2, 0}}).substr(0, 38),
            "materials/a/baseColorFactor is 2, must");
  EXPECT_NE(complaint({.name = "a", .metallic = -1}).find("metallicFactor is -1"),
            std::string::npos);
  EXPECT_NE(complaint({.name = "a", .roughness = std::nan("")}).find("roughnessFactor is nan"),
            std::string::npos);
  EXPECT_NE(complaint({.name = "a", .metallic = 0, .ior = 0.5}).find("index is 0.5"),
            std::string::npos);
  EXPECT_NE(complaint({.name = "a", .attenuation_distance_m = 0}).find("attenuationDistance is 0"),
            std::string::npos);
}

}  // namespace
}  // namespace scan::synth
