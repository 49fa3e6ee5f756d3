// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The keys of a recipe's lights and of the medium that its scene stands in.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "libscan/io/json_reader.h"
#include "synth/scene.h"

namespace scan {

// A light and the image of an environment, empty without one.
struct RecipeLight {
  synth::Light light;
  std::filesystem::path image;
};
// {"point": ...}, {"area": ...} or {"environment": ...}; images are relative to `folder`.
RecipeLight read_light(JsonReader reader, const std::filesystem::path& folder);
nlohmann::ordered_json to_json(const RecipeLight& light);

// A medium and the file of its density (a three-dimensional NumPy array, indexed z, y, x).
struct RecipeMedium {
  synth::Medium medium;
  std::filesystem::path density;
};
// Coefficients; or {"fog": {"optical_range_m": 100}} (5 % contrast, any wavelength); or
// {"haze": {"visibility_m": 8000}} (2 % contrast at 550 nm), carried over to the device's
// wavelength.
RecipeMedium read_medium(JsonReader reader, const std::filesystem::path& folder,
                         double wavelength_m);
nlohmann::ordered_json to_json(const RecipeMedium& medium);

}  // namespace scan
