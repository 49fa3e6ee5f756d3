// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Materials of glTF 2.0 (Khronos 2021: metallic and roughness; KHR_materials_ior, _transmission and
// _volume) as libscan's, at one wavelength.
#pragma once

#include <array>
#include <limits>
#include <string>

#include "synth/scene.h"

namespace scan::synth {

using LinearRgb = std::array<double, 3>;

// With glTF's defaults.
struct GltfMaterial {
  std::string name;
  LinearRgb base_colour = {1, 1, 1};
  double metallic = 1;
  double roughness = 1;  // perceived; alpha is its square
  double ior = 1.5;
  double transmission = 0;
  double attenuation_distance_m = std::numeric_limits<double>::infinity();
  LinearRgb attenuation_colour = {1, 1, 1};  // what is left of white light after that distance
};

// Linear between the dominant wavelengths of sRGB's primaries, 464, 549 and 611 nm, and constant
// beyond: of infrared an RGB colour tells nothing.
double colour_at(const LinearRgb& colour, double wavelength_m);

// glTF mixes three models, of which the heavier one is taken: metal from metallic 0.5 on, clear
// from transmission 0.5 on, else coated. Metal: k is such that a face reflects the base colour (eta
// 1). Clear: the volume's attenuation fills the body; the base colour, a tint of thin sheets, is
// left out. Coated: the light that enters leaves as base colour. Throws scan::Error (input).
Material material_from_gltf(const GltfMaterial& gltf, double wavelength_m);

}  // namespace scan::synth
