// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/tradeoff_page.h"

#include <nlohmann/json.hpp>
#include <set>

#include "tools/console.h"
#include "tools/report/html.h"
#include "tools/report/tradeoff_plot.h"
#include "tools/version.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

std::string text_of(const ordered_json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// "reconstruct/depth 7, align/method symmetric"
std::string settings_text(const ordered_json& settings) {
  std::string text;
  for (const auto& [key, value] : settings.items())
    text += (text.empty() ? "" : ", ") + key + " " + text_of(value);
  return text;
}

double number(const ordered_json& value) {
  return value.is_number() ? value.get<double>() : 0;
}

// One curve for each value of the first field whose values are words, else a single one.
std::string curve_of(const ordered_json& settings) {
  for (const auto& [key, value] : settings.items())
    if (value.is_string()) return value.get<std::string>();
  return "all settings";
}

std::vector<TradeoffMark> marks_of(const ordered_json& tradeoff) {
  std::vector<TradeoffMark> marks;
  const ordered_json& advice = tradeoff.at("advice");
  for (const auto& run : tradeoff.at("runs")) {
    const bool advised = advice.contains("settings") && advice.at("settings") == run.at("settings");
    marks.push_back({.seconds = number(run.at("seconds")),
                     .error = number(run.at("error_m")),
                     .least_error = number(run.at("least_error")),
                     .most_error = number(run.at("most_error")),
                     .curve = curve_of(run.at("settings")),
                     .label = settings_text(run.at("settings")),
                     .on_front = run.at("on_front").get<bool>(),
                     .advised = advised});
  }
  return marks;
}

std::string seconds_text(const ordered_json& value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", number(value));
  return text;
}

std::string run_table(const ordered_json& tradeoff, const std::string& unit) {
  std::string html = "<h3>Settings</h3><div class=\"wide\"><table><tr>";
  for (const auto& [key, value] : tradeoff.at("runs").at(0).at("settings").items())
    html += "<th>" + escaped(key) + "</th>";
  html +=
      "<th class=\"number\">error</th>"
      "<th class=\"number\">least</th><th class=\"number\">most</th>"
      "<th class=\"number\">runs</th>";
  std::set<std::string> stages;
  for (const auto& run : tradeoff.at("runs"))
    for (const auto& [stage, s] : run.at("stage_seconds").items()) stages.insert(stage);
  for (const std::string& stage : stages) html += "<th class=\"number\">" + stage + ", s</th>";
  html += "<th class=\"number\">total, s</th><th>front</th></tr>";
  const auto error = [&](const ordered_json& value) {
    return value.is_number() ? readable_value(value.get<double>(), unit) : "unknown";
  };
  for (const auto& run : tradeoff.at("runs")) {
    html += "<tr>";
    for (const auto& [key, value] : run.at("settings").items()) html += cell(text_of(value));
    html += cell(error(run.at("error_m")), true) + cell(error(run.at("least_error")), true) +
            cell(error(run.at("most_error")), true) +
            cell(std::to_string(run.at("count").get<std::size_t>()), true);
    for (const std::string& stage : stages)
      html += cell(seconds_text(run.at("stage_seconds").value(stage, ordered_json())), true);
    const std::string trouble = run.at("trouble").get<std::string>();
    html += cell(seconds_text(run.at("seconds")), true) +
            cell(!trouble.empty()                 ? trouble
                 : run.at("on_front").get<bool>() ? "yes"
                                                  : "") +
            "</tr>";
  }
  return html + "</table></div>";
}

std::string source_table(const ordered_json& sources, const std::string& unit) {
  if (sources.empty()) return "";
  std::string html =
      "<h3>Where the error comes from</h3><p>Runs of the advised settings with the same random "
      "streams, spared one source after another.</p><table><tr><th>source</th>"
      "<th class=\"number\">share of the mean square</th><th class=\"number\">error</th></tr>";
  for (const auto& source : sources) {
    char share[32];
    std::snprintf(share, sizeof share, "%.0f %%", 100 * number(source.at("share")));
    html += "<tr>" + cell(source.at("source").get<std::string>()) + cell(share, true) +
            cell(readable_value(number(source.at("error_m")), unit), true) + "</tr>";
  }
  return html + "</table>";
}

}  // namespace

std::string tradeoff_parts(const ordered_json& tradeoff) {
  const std::string unit = tradeoff.at("unit").get<std::string>();
  const std::string figure = tradeoff.at("figure").get<std::string>();
  return "<p><strong>" + escaped(tradeoff.at("advice").at("text").get<std::string>()) +
         "</strong></p><p>Filled marks are the front: nothing tried is both better and faster. "
         "Bars reach from the least to the most of the seeds. " +
         std::to_string(tradeoff.at("threads").get<int>()) + " threads, " +
         escaped(tradeoff.at("machine").get<std::string>()) + ".</p>" +
         tradeoff_plot(marks_of(tradeoff), figure, unit, number(tradeoff.at("tolerance"))) +
         source_table(tradeoff.at("sources"), unit) + run_table(tradeoff, unit);
}

std::string tradeoff_page(const std::string& title, const ordered_json& tradeoff) {
  const std::string whole = title + ": what accuracy costs";
  return page_head(whole) + "<h1>" + escaped(whole) + "</h1><p class=\"quiet\">libscan " +
         version_text() + "</p><main>" + tradeoff_parts(tradeoff) + "</main></body></html>\n";
}

}  // namespace scan
