// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/left_out.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "synth/effects/weight.h"
#include "tools/run_files.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

// Infinite where it is unknown.
double sigmas(const ordered_json& effect) {
  const ordered_json bound = effect.value("bound_sigma", ordered_json());
  return bound.is_number() ? bound.get<double>() : std::numeric_limits<double>::infinity();
}

std::string bound_text(const ordered_json& effect) {
  if (!effect.at("bound_m").is_number() || !effect.at("bound_sigma").is_number())
    return "bound unknown";
  char text[96];
  std::snprintf(text, sizeof text, "up to %s, %.3g sigma",
                readable_length(effect.at("bound_m").get<double>()).c_str(), sigmas(effect));
  return text;
}

ordered_json read_if_there(const std::filesystem::path& path) {
  return std::filesystem::exists(path) ? read_ordered_json(path) : ordered_json();
}

}  // namespace

bool is_left_out(const ordered_json& effect) {
  return effect.value("decision", "") == "off" && sigmas(effect) >= synth::negligible_sigma;
}

ordered_json left_out_effects(const ordered_json& effects, const ordered_json& recipe) {
  ordered_json list = ordered_json::array();
  if (!effects.is_array()) return list;
  const bool by_plan = recipe.is_object() && recipe.value("effects", ordered_json()) == "auto";
  for (const auto& effect : effects)
    if (is_left_out(effect))
      list.push_back({{"effect", effect.value("effect", "")},
                      {"bound_m", effect.value("bound_m", ordered_json())},
                      {"bound_sigma", effect.value("bound_sigma", ordered_json())},
                      {"by", by_plan ? "plan" : "recipe"}});
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return sigmas(a) > sigmas(b); });
  return list;
}

std::string left_out_text(const ordered_json& left_out) {
  if (left_out.empty()) return "";
  std::string text = "the verdict does not know what the " +
                     left_out.front().at("by").get<std::string>() + " left out:";
  for (const auto& effect : left_out)
    text += (text.ends_with(":") ? " " : ", ") + effect.at("effect").get<std::string>() + " (" +
            bound_text(effect) + ")";
  return text;
}

void tell_left_out(const std::filesystem::path& run, ordered_json& verdict, Console& console) {
  const std::filesystem::path effects = run / "effects.json";
  try {
    verdict["left_out"] = left_out_effects(read_if_there(effects), read_if_there(recipe_path(run)));
  } catch (const nlohmann::json::exception& error) {
    throw Error(Trouble::input, effects.string() + ": holds no effects: " + error.what());
  }
  const std::string text = left_out_text(verdict["left_out"]);
  if (!text.empty() && console.json) console.warn(text);
}

}  // namespace scan
