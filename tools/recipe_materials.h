// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The keys of a recipe's materials.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "libscan/io/json_reader.h"
#include "synth/scene.h"
#include "tools/fields.h"

namespace scan {

// {"diffuse": 0.6}, with "slope_deg" a rough matt surface; {"conductor": "iron", "roughness": 0.2};
// {"dielectric": "bk7"}, with "interior" absorbing or translucent; {"plastic": 1.5, "diffuse":
// 0.5}. Names of conductors and clear media are looked up at `wavelength_m`, the scanner's.
// {"gltf": {"base_colour": [r, g, b], "metallic": 1, "roughness": 0.5, ...}} is glTF's model.
// "texture": {"checker": ...}, {"noise": ...} or {"picture": {"file": "grain.png", "width_mm":
// 40}}, which lies upon the object's xy plane; without a width it is laid on a mesh by its texture
// coordinates. Pictures are relative to `folder`; `picture` becomes the texture's.
synth::Material read_material(JsonReader reader, const std::string& name, double wavelength_m,
                              const std::filesystem::path& folder, std::filesystem::path& picture);
nlohmann::ordered_json to_json(const synth::Material& material,
                               const std::filesystem::path& picture);

// Absorption, scattering and phase function.
void fields(Fields& f, synth::Medium& medium);

}  // namespace scan
