// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/study.h"

#include <algorithm>
#include <sstream>

#include "libscan/core/error.h"
#include "tools/figure_name.h"

namespace scan {
namespace {

FieldValues read_fields(JsonReader& reader) {
  const nlohmann::json& set = reader.value("set");
  if (!set.is_object() || set.empty())
    reader.fail("set", "must be an object with at least one field: {\"reconstruct/depth\": 7}");
  FieldValues fields;
  for (const auto& [field, value] : set.items()) fields.emplace_back(field, value);
  return fields;
}

template <class Named>
bool holds(const std::vector<Named>& list, const std::string& name) {
  return std::any_of(list.begin(), list.end(), [&](const Named& n) { return n.name == name; });
}

// A study makes its figure small: those that are best when large, at 1, or at what the body has,
// would lead it astray.
std::string read_error(JsonReader& reader) {
  const std::string name = read_figure(reader, "error", FigureSource::surface_or_run);
  const bool large_is_good =
      name == "f_score" || name == "ray_hit_fraction" || name.ends_with("_within_95");
  if (large_is_good)
    reader.fail("error", "'" + name + "' is better the larger it is; a study wants an error");
  if (name.starts_with("normalised_") || name == "genus" || name == "components")
    reader.fail("error", "'" + name + "' is not better the smaller it is; a study wants an error");
  return name;
}

Variation read_field(JsonReader& reader) {
  Variation variation{.name = reader.text("key"), .choices = {}};
  const nlohmann::json& values = reader.value("values");
  if (!values.is_array() || values.empty())
    reader.fail("values", "must be a list with at least one value");
  for (const nlohmann::json& value : values)
    variation.choices.push_back({value, {{variation.name, value}}});
  return variation;
}

Variation read_choices(JsonReader& reader) {
  Variation variation{.name = reader.text("name"), .choices = {}};
  for (JsonReader& choice : reader.objects("choices")) {
    const std::string name = choice.text("name");
    variation.choices.push_back({name, read_fields(choice)});
    choice.finish();
  }
  if (variation.choices.empty()) reader.fail("choices", "must be a list with at least one choice");
  return variation;
}

std::vector<Case> read_cases(JsonReader& reader) {
  std::vector<Case> cases;
  if (!reader.has("cases")) return {Case()};
  for (JsonReader& entry : reader.objects("cases")) {
    const std::string name = entry.text("name");
    if (holds(cases, name)) entry.fail("name", "\"" + name + "\" is the name of two cases");
    cases.push_back({name, read_fields(entry)});
    entry.finish();
  }
  if (cases.empty()) reader.fail("cases", "must be a list with at least one case");
  return cases;
}

void put(nlohmann::json& recipe, const std::string& field, const nlohmann::json& value) {
  nlohmann::json* place = &recipe;
  std::istringstream way(field);
  for (std::string word; std::getline(way, word, '/');) {
    if (!place->is_object() && !place->is_null())
      throw Error(Trouble::input,
                  "tradeoff: \"" + field + "\" leads into a value that is no object");
    place = &(*place)[word];
  }
  *place = value;
}

void apply(StudyRecipe& run, const FieldValues& set) {
  for (const auto& [field, value] : set) {
    if (field != "threads") {
      put(run.recipe, field, value);
      continue;
    }
    if (!value.is_number_integer() || value < 1)
      throw Error(Trouble::input, "tradeoff: threads: " + value.dump() + ", must be 1 or more");
    run.threads = value.get<int>();
  }
}

}  // namespace

const std::vector<std::string>& timed_stages() {
  static const std::vector<std::string> stages = {"all", "simulate", "acquire", "align",
                                                  "reconstruct"};
  return stages;
}

const std::vector<std::string>& study_clocks() {
  static const std::vector<std::string> clocks = {"wall", "processor"};
  return clocks;
}

Study read_study(JsonReader reader) {
  Study study;
  study.seeds = static_cast<int>(reader.integer("seeds", study.seeds));
  if (study.seeds < 1 || study.seeds > 1000)
    reader.fail("seeds", "is " + std::to_string(study.seeds) + ", must be 1 to 1000");
  if (reader.has("error")) study.error = read_error(reader);
  study.seconds = reader.text("seconds", study.seconds);
  const std::vector<std::string>& stages = timed_stages();
  if (std::find(stages.begin(), stages.end(), study.seconds) == stages.end())
    reader.fail("seconds", "is \"" + study.seconds +
                               "\", must be all, simulate, acquire, align or reconstruct");
  study.clock = reader.text("clock", study.clock);
  const std::vector<std::string>& clocks = study_clocks();
  if (std::find(clocks.begin(), clocks.end(), study.clock) == clocks.end())
    reader.fail("clock", "is \"" + study.clock + "\", must be wall or processor");
  for (JsonReader& entry : reader.objects("vary")) {
    Variation variation = entry.has("key") ? read_field(entry) : read_choices(entry);
    entry.finish();
    if (holds(study.vary, variation.name))
      entry.fail("key", "\"" + variation.name + "\" is varied twice");
    study.vary.push_back(std::move(variation));
  }
  if (study.vary.empty()) reader.fail("vary", "must name at least one field");
  study.cases = read_cases(reader);
  reader.finish();
  return study;
}

std::vector<Setting> grid(const Study& study) {
  std::vector<Setting> settings{Setting()};
  for (const Variation& variation : study.vary) {
    std::vector<Setting> longer;
    for (const Setting& setting : settings)
      for (std::size_t i = 0; i < variation.choices.size(); ++i) {
        longer.push_back(setting);
        longer.back().push_back(i);
      }
    settings = std::move(longer);
  }
  return settings;
}

nlohmann::ordered_json setting_json(const Study& study, const Setting& setting) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < study.vary.size(); ++i)
    json[study.vary[i].name] = study.vary[i].choices[setting[i]].label;
  return json;
}

double seconds_of(const Study& study, const std::string& stage, const StageCost& cost) {
  if (study.seconds != "all" && study.seconds != stage) return 0;
  return study.clock == "wall" ? cost.seconds : cost.processor_seconds;
}

double seconds_of(const Study& study, const StageCosts& stages) {
  double sum = 0;
  for (const auto& [stage, cost] : stages) sum += seconds_of(study, stage, cost);
  return sum;
}

std::string seconds_text(const Study& study) {
  return (study.clock == "wall" ? "seconds" : "processor seconds") +
         (study.seconds == "all" ? "" : " of " + study.seconds);
}

StudyRecipe with_setting(const nlohmann::json& recipe, const Study& study, const Case& in,
                         const Setting& setting) {
  StudyRecipe run{.recipe = recipe};
  apply(run, in.set);
  for (std::size_t i = 0; i < study.vary.size(); ++i)
    apply(run, study.vary[i].choices[setting[i]].set);
  return run;
}

}  // namespace scan
