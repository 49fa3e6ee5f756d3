// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/gltf_material.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/error.h"
#include "libscan/core/shortest.h"
#include "synth/bsdf/fresnel.h"

namespace scan::synth {
namespace {

void check_share(const std::string& field, double value) {
  if (value >= 0 && value <= 1) return;
  throw Error(Trouble::input, field + " is " + shortest(value) + ", must be from 0 to 1");
}

void check(const GltfMaterial& gltf, const std::string& place) {
  for (const double part : gltf.base_colour) check_share(place + "/baseColorFactor", part);
  for (const double part : gltf.attenuation_colour) check_share(place + "/attenuationColor", part);
  check_share(place + "/metallicFactor", gltf.metallic);
  check_share(place + "/roughnessFactor", gltf.roughness);
  check_share(place + "/transmissionFactor", gltf.transmission);
  if (!(gltf.attenuation_distance_m > 0))
    throw Error(Trouble::input, place + "/attenuationDistance is " +
                                    shortest(gltf.attenuation_distance_m) + ", must be positive");
}

Conductor metal(double reflectance, double alpha) {
  // k^2 / (4 + k^2) is the reflectance for eta 1; a perfect mirror's k would be infinite
  const double share = std::min(reflectance, 0.9995);
  return {.eta = 1, .k = 2 * std::sqrt(share / (1 - share)), .roughness = alpha};
}

Plastic coated(double colour, double index, double alpha) {
  // colour = albedo (1 - i) / (1 - i albedo), with i the coat's inner reflectance
  const double inner = index > 1 ? fresnel_dielectric_mean(1 / index) : 0;
  return {.albedo = colour / (1 - inner + inner * colour), .index = index, .roughness = alpha};
}

Medium attenuating(const GltfMaterial& gltf, double wavelength_m) {
  // black would need infinite absorption; a millionth is black to any detector
  const double left = std::max(colour_at(gltf.attenuation_colour, wavelength_m), 1e-6);
  Medium medium;
  medium.absorption_per_m = -std::log(left) / gltf.attenuation_distance_m;
  return medium;
}

}  // namespace

double colour_at(const LinearRgb& colour, double wavelength_m) {
  constexpr double blue_m = 464e-9, green_m = 549e-9, red_m = 611e-9;
  const double to_green = std::clamp((wavelength_m - blue_m) / (green_m - blue_m), 0.0, 1.0);
  const double to_red = std::clamp((wavelength_m - green_m) / (red_m - green_m), 0.0, 1.0);
  return colour[2] + to_green * (colour[1] - colour[2]) + to_red * (colour[0] - colour[1]);
}

Material material_from_gltf(const GltfMaterial& gltf, double wavelength_m) {
  const std::string place = "materials/" + gltf.name;
  check(gltf, place);
  const double alpha = gltf.roughness * gltf.roughness;
  const double colour = colour_at(gltf.base_colour, wavelength_m);
  Material material{.name = gltf.name};
  if (gltf.metallic >= 0.5) {
    material.bsdf = metal(colour, alpha);
  } else if (gltf.transmission >= 0.5) {
    material.bsdf = Dielectric{.index = gltf.ior, .roughness = alpha};
    if (std::isfinite(gltf.attenuation_distance_m))
      material.interior = attenuating(gltf, wavelength_m);
  } else {
    material.bsdf = coated(colour, gltf.ior, alpha);
  }
  check(material.bsdf, place);
  return material;
}

}  // namespace scan::synth
