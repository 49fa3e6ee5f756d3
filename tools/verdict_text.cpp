// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/verdict_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/left_out.h"

namespace scan {

using nlohmann::ordered_json;

namespace {

bool is_pair(const ordered_json& value) {
  return value.is_array() && value.size() == 2 && value[0].is_number() && value[1].is_number();
}

}  // namespace

std::string statement_remark(const ordered_json& measurement) {
  const ordered_json expected = measurement.value("expected", ordered_json()),
                     value = measurement.value("value", ordered_json());
  if (!is_pair(expected) || !value.is_number()) return "";
  if (value.get<double>() > expected[1].get<double>()) return "uncertainty stated too small";
  return value.get<double>() < expected[0].get<double>() ? "uncertainty stated too large" : "";
}

std::string prediction_remark(const ordered_json& measurement) {
  const ordered_json predicted = measurement.value("predicted", ordered_json()),
                     value = measurement.value("value", ordered_json());
  if (!is_pair(predicted) || !value.is_number()) return "";
  const double low = predicted[0].get<double>(), high = predicted[1].get<double>();
  const double is = value.get<double>();
  // what lies to both sides of 0 does so alike: which draw went farthest is chance
  const double most = std::max(std::abs(low), std::abs(high));
  if (std::abs(is) > most) return "larger than predicted";
  return (low <= is && is <= high) || (low < 0 && high > 0) ? "" : "smaller than predicted";
}

void say_verdict(const ordered_json& verdict, const Console& console) {
  const auto readable = [](const ordered_json& value, const std::string& unit) {
    return value.is_number() ? readable_value(value.get<double>(), unit) : "unknown";
  };
  for (const auto& m : verdict.at("measurements")) {
    const std::string unit = m.at("unit");
    char line[256];
    std::snprintf(line, sizeof line, "  %-28s %12s", m.at("name").get<std::string>().c_str(),
                  readable(m.at("value"), unit).c_str());
    std::string text = line;
    const auto range = [&](const char* key) {
      return readable(m.at(key)[0], unit) + " to " + readable(m.at(key)[1], unit);
    };
    if (is_pair(m.value("interval", ordered_json())))
      text += "   (95 %: " + range("interval") + ")";
    if (is_pair(m.value("predicted", ordered_json()))) text += "   predicted " + range("predicted");
    if (!m.at("limit").is_null())
      text += std::string("   ") + (m.at("pass").get<bool>() ? "pass" : "FAIL") + " (" +
              m.at("relation").get<std::string>() + " " + readable(m.at("limit"), unit) + ")";
    if (const std::string remark = statement_remark(m); !remark.empty())
      text += "   " + remark + " (honest: " + range("expected") + ")";
    if (const std::string remark = prediction_remark(m); !remark.empty()) text += "   " + remark;
    console.say(text);
    console.say("      " + m.at("definition").get<std::string>() + " [" +
                m.at("over").get<std::string>() +
                "; n = " + std::to_string(m.at("count").get<std::size_t>()) + "]");
  }
  const auto& all = verdict.at("measurements");
  const bool is_judged =
      std::any_of(all.begin(), all.end(), [](const auto& m) { return !m.at("limit").is_null(); });
  const std::string word = !is_judged                       ? "no limits, no verdict"
                           : verdict.at("pass").get<bool>() ? "PASS"
                                                            : "FAIL";
  console.say(word);
  const std::string unknown = left_out_text(verdict.value("left_out", ordered_json::array()));
  if (!unknown.empty()) console.say("  " + unknown);
}

}  // namespace scan
