// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A recipe: one complete experiment, from scene to limits, as JSON.
//
// The keys stand in recipe_scanner.cpp and recipe_stages.cpp (one list for reading, writing and the
// schema) and in recipe_scene.cpp, recipe_materials.cpp and recipe_lights.cpp (whose schema stands
// in scene_schema.cpp); `scan run` writes the recipe back with all defaults filled in.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "libscan/acquire/acquire.h"
#include "libscan/align/multiview.h"
#include "libscan/reconstruct/reconstruct.h"
#include "libscan/verify/definitions.h"
#include "libscan/verify/verdict.h"
#include "synth/artefacts.h"
#include "synth/effects/plan.h"
#include "synth/scanner.h"
#include "synth/viewpoints.h"
#include "tools/recipe_scene.h"

namespace scan {

inline constexpr long recipe_version = 1;  // of the keys, "libscan"

struct ReconstructSettings {
  ReconstructMethod method = ReconstructMethod::ssd;
  SsdOptions ssd;
  bool sharp = false;      // edges and corners put back
  bool quads = false;      // the dual surface
  double thin_m = 0;       // voxel side before reconstruction; 0: none
  double trim_m = 0;       // surface farther from data is removed; 0: nothing is
  double decimate_m = 0;   // triangles are merged within this distance; 0: none are
  double max_sigma_m = 0;  // points with a larger sigma are left out; 0: none are
};

struct VerifySettings {
  double seen_distance_m = 0;  // completeness counts truth this near to a point; 0: all of it
  double f_score_threshold_m = 0;
  int samples = 200'000;
};

struct Recipe {
  std::string name;
  std::uint64_t seed = 1;
  RecipeScene scene;
  synth::Scanner scanner;
  synth::Viewpoints viewpoints;
  synth::EffectChoice effects;
  AcquireOptions acquire;
  MultiviewOptions align;
  ReconstructSettings reconstruct;
  VerifySettings verify;
  std::optional<synth::Artefacts> artefacts;  // for `scan verify --artefacts`
  std::vector<Limit> artefact_limits;
  std::vector<Limit> limits;
};

// scan::Error (input) names file, key, value and limit; meshes are read relative to the recipe.
Recipe read_recipe(const std::filesystem::path& path);
// The same from JSON; `place` is how messages name it, `folder` where its meshes lie.
Recipe read_recipe(const nlohmann::json& json, const std::string& place,
                   const std::filesystem::path& folder);

// A JSON list of limits, as a recipe has them, on figures of what is measured.
std::vector<Limit> read_limits(const std::filesystem::path& path, FigureSource source);

// With all defaults filled in, SI units; reading it back gives the same recipe. Meshes are named by
// their absolute path.
nlohmann::ordered_json to_json(const Recipe& recipe);

}  // namespace scan
