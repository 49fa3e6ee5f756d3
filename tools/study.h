// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a trade-off study varies: some of a recipe's fields, each over a list of values.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "libscan/io/json_reader.h"

namespace scan {

// `key` is the way to the field in the recipe: "reconstruct/depth", "scanner/laser_line/step_mm".
struct Variation {
  std::string key;
  std::vector<nlohmann::json> values;
};

struct Study {
  std::vector<Variation> vary;
  int seeds = 3;                       // runs of each setting, with seeds that follow one another
  std::string error = "accuracy_rms";  // the figure of the verdict that counts
};

// "vary", "seeds" and "error" of a recipe's "tradeoff". scan::Error (input) for a list without
// values, a key named twice, or fewer than one seed.
Study read_study(JsonReader reader);

// One value of each variation, by its index.
using Setting = std::vector<std::size_t>;

// All of them; the last variation counts fastest.
std::vector<Setting> grid(const Study& study);

// {"reconstruct/depth": 7, ...}: how a setting is shown and stored.
nlohmann::ordered_json setting_json(const Study& study, const Setting& setting);

// The recipe with the setting's values in their places; objects on the way are made where they are
// missing. scan::Error (input) if a value stands where an object is needed.
nlohmann::json with_setting(nlohmann::json recipe, const Study& study, const Setting& setting);

}  // namespace scan
