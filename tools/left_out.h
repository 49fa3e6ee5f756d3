// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Effects that a simulation left out although they would have moved its ranges: what its verdict
// cannot know.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/console.h"

namespace scan {

// Of an entry of effects.json: it is off although its bound is beyond what the planner may leave
// out (synth::negligible_sigma), or unknown.
bool is_left_out(const nlohmann::ordered_json& effect);

// Those of an effects.json: [{`effect`, `bound_m`, `bound_sigma`, `by`}], the largest share of
// sigma first. `by` is "plan" where the recipe lets the planner choose, else "recipe".
nlohmann::ordered_json left_out_effects(const nlohmann::ordered_json& effects,
                                        const nlohmann::ordered_json& recipe);

// "the verdict does not know what the recipe left out: footprint (up to 8.83 mm, 58.7 sigma)".
// Empty for an empty list.
std::string left_out_text(const nlohmann::ordered_json& left_out);

// Gives the verdict of a run the key "left_out", for say_verdict(), and with --json a warning of
// what it lists. The verdict stays as it is: it judges what was simulated. scan::Error (input) for
// broken files in the folder.
void tell_left_out(const std::filesystem::path& run, nlohmann::ordered_json& verdict,
                   Console& console);

}  // namespace scan
