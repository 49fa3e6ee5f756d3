// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The keys of a recipe's scene.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "libscan/io/json_reader.h"
#include "synth/scene.h"
#include "tools/recipe_lights.h"

namespace scan {

// `mesh_files[i]` is the file of object i, empty for an analytic shape; `mesh_units_m[i]` its unit.
struct RecipeScene {
  synth::Scene scene;
  std::vector<std::filesystem::path> mesh_files;
  std::vector<double> mesh_units_m;
  std::vector<std::filesystem::path> texture_files;  // per material, empty without a picture
  std::vector<RecipeLight> lights;                   // as in the scene, with their files
  std::optional<RecipeMedium> medium;
};

// What an object's "shape" may be in one word, and its mesh's "unit".
std::vector<std::string> model_names();
std::vector<std::string> mesh_unit_names();

// Files are relative to `folder`; materials have the indices of refraction at `wavelength_m`.
RecipeScene read_scene(JsonReader reader, const std::filesystem::path& folder, double wavelength_m);
nlohmann::ordered_json to_json(const RecipeScene& scene);

}  // namespace scan
