// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/study.h"

#include <algorithm>
#include <sstream>

#include "libscan/core/error.h"

namespace scan {

Study read_study(JsonReader reader) {
  Study study;
  study.seeds = static_cast<int>(reader.integer("seeds", study.seeds));
  study.error = reader.text("error", study.error);
  if (study.seeds < 1 || study.seeds > 1000)
    reader.fail("seeds", "is " + std::to_string(study.seeds) + ", must be 1 to 1000");
  for (JsonReader& entry : reader.objects("vary")) {
    Variation variation{.key = entry.text("key"), .values = {}};
    const nlohmann::json& values = entry.value("values");
    if (!values.is_array() || values.empty())
      entry.fail("values", "must be a list with at least one value");
    variation.values.assign(values.begin(), values.end());
    entry.finish();
    const bool twice = std::any_of(study.vary.begin(), study.vary.end(),
                                   [&](const Variation& v) { return v.key == variation.key; });
    if (twice) entry.fail("key", "\"" + variation.key + "\" is varied twice");
    study.vary.push_back(std::move(variation));
  }
  if (study.vary.empty()) reader.fail("vary", "must name at least one field");
  reader.finish();
  return study;
}

std::vector<Setting> grid(const Study& study) {
  std::vector<Setting> settings{Setting()};
  for (const Variation& variation : study.vary) {
    std::vector<Setting> longer;
    for (const Setting& setting : settings)
      for (std::size_t i = 0; i < variation.values.size(); ++i) {
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
    json[study.vary[i].key] = study.vary[i].values[setting[i]];
  return json;
}

nlohmann::json with_setting(nlohmann::json recipe, const Study& study, const Setting& setting) {
  for (std::size_t i = 0; i < study.vary.size(); ++i) {
    nlohmann::json* place = &recipe;
    std::istringstream way(study.vary[i].key);
    for (std::string word; std::getline(way, word, '/');) {
      if (!place->is_object() && !place->is_null())
        throw Error(Trouble::input, "tradeoff/vary: \"" + study.vary[i].key +
                                        "\" leads into a value that is no object");
      place = &(*place)[word];
    }
    *place = study.vary[i].values[setting[i]];
  }
  return recipe;
}

}  // namespace scan
