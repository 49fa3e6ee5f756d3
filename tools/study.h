// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a trade-off study varies: fields of a recipe, each over a list of values, in one case or
// several.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "libscan/io/json_reader.h"

namespace scan {

// Fields of a recipe and what they become. A field is the way to it: "reconstruct/depth",
// "scanner/laser_line/step_mm", or "threads", which no recipe has: how many may work.
using FieldValues = std::vector<std::pair<std::string, nlohmann::json>>;

struct Choice {
  nlohmann::json label;  // the value of a single field, else a name
  FieldValues set;
};

struct Variation {
  std::string name;  // of its field, if it has only one
  std::vector<Choice> choices;
};

// Circumstances that nobody is free to choose, such as noisy data: each gets an advice of its own.
struct Case {
  std::string name;
  FieldValues set;
};

struct Study {
  std::vector<Variation> vary;
  std::vector<Case> cases;             // at least one, nameless if the recipe has none
  int seeds = 3;                       // runs of each setting, with seeds that follow one another
  std::string error = "accuracy_rms";  // the figure of the verdict that counts
  std::string seconds = "all";         // of which stage count
  std::string clock = "wall";          // or "processor": what a second is
};

// What "seconds" may be, "all" or a stage; and "clock".
const std::vector<std::string>& timed_stages();
const std::vector<std::string>& study_clocks();

// A recipe's "tradeoff":
//   "vary": [{"key": "reconstruct/depth", "values": [6, 7, 8]},
//            {"name": "scanner", "choices": [{"name": "stereo", "set": {FIELD: VALUE, ...}},
//            ...]}],
//   "cases": [{"name": "noisy", "set": {FIELD: VALUE, ...}}, ...],
//   "seeds", "error", "seconds" ("all", "simulate", "acquire", "align" or "reconstruct"), "clock"
//   ("wall", or "processor": of all threads together, which a busy machine hardly changes).
// scan::Error (input) for a list without values, a name used twice, or fewer than one seed.
Study read_study(JsonReader reader);

// One choice of each variation, by its index.
using Setting = std::vector<std::size_t>;

// All of them; the last variation counts fastest.
std::vector<Setting> grid(const Study& study);

// {"reconstruct/depth": 7, ...}: how a setting is shown and stored.
nlohmann::ordered_json setting_json(const Study& study, const Setting& setting);

// What a stage took by either clock, and the program's largest resident memory meanwhile.
struct StageCost {
  double seconds = 0;
  double processor_seconds = 0;
  double peak_mib = 0;
};
using StageCosts = std::map<std::string, StageCost>;  // by the stage's name

// The seconds that count in this study: of a stage, none if its seconds do not, and of all.
double seconds_of(const Study& study, const std::string& stage, const StageCost& cost);
double seconds_of(const Study& study, const StageCosts& stages);

// What they are called: "seconds of align", "processor seconds".
std::string seconds_text(const Study& study);

struct StudyRecipe {
  nlohmann::json recipe;
  int threads = 0;  // 0: as many as the program has
};

// The recipe in that case with the setting's values in their places; objects on the way are made
// where they are missing. scan::Error (input) if a value stands where an object is needed.
StudyRecipe with_setting(const nlohmann::json& recipe, const Study& study, const Case& in,
                         const Setting& setting);

}  // namespace scan
