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

// What is advised in a run's case.
bool is_advised(const ordered_json& tradeoff, const ordered_json& run) {
  for (const ordered_json& in : tradeoff.at("cases"))
    if (in.at("name") == run.at("case"))
      return in.at("advice").value("settings", ordered_json()) == run.at("settings");
  return false;
}

std::vector<TradeoffMark> marks_of(const ordered_json& tradeoff) {
  std::vector<TradeoffMark> marks;
  for (const auto& run : tradeoff.at("runs"))
    marks.push_back({.seconds = number(run.at("seconds")),
                     .error = number(run.at("error_m")),
                     .least_error = number(run.at("least_error")),
                     .most_error = number(run.at("most_error")),
                     .panel = run.at("case").get<std::string>(),
                     .curve = curve_of(run.at("settings")),
                     .label = settings_text(run.at("settings")),
                     .on_front = run.at("on_front").get<bool>(),
                     .advised = is_advised(tradeoff, run)});
  return marks;
}

std::string rounded(const ordered_json& value) {
  if (!value.is_number()) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", number(value));
  return text;
}

std::set<std::string> stages_of(const ordered_json& runs) {
  std::set<std::string> stages;
  for (const auto& run : runs)
    for (const auto& [stage, cost] : run.at("stages").items()) stages.insert(stage);
  return stages;
}

std::string heads(const ordered_json& runs) {
  std::string html = "<h3>Settings</h3><div class=\"wide settings\" tabindex=\"0\"><table><tr>";
  for (const auto& [key, value] : runs.at(0).at("settings").items())
    html += "<th>" + escaped(key) + "</th>";
  for (const char* number : {"error", "least", "most", "runs"})
    html += std::string("<th class=\"number\">") + number + "</th>";
  html += "<th class=\"number\">seconds</th>";
  for (const std::string& stage : stages_of(runs))
    html += "<th class=\"number\">" + stage + ", s</th>";
  return html + "<th class=\"number\">peak, MiB</th><th>front</th></tr>";
}

double peak_mib(const ordered_json& run) {
  double peak = 0;
  for (const auto& [stage, cost] : run.at("stages").items())
    peak = std::max(peak, number(cost.at("peak_mib")));
  return peak;
}

std::string run_table(const ordered_json& tradeoff, const std::string& unit) {
  const ordered_json& runs = tradeoff.at("runs");
  const std::set<std::string> stages = stages_of(runs);
  const auto error = [&](const ordered_json& value) {
    return value.is_number() ? readable_value(value.get<double>(), unit) : "unknown";
  };
  std::string html = heads(runs);
  const std::size_t columns = runs.at(0).at("settings").size() + stages.size() + 7;
  ordered_json in = "";
  for (const auto& run : runs) {
    if (run.at("case") != in) {
      in = run.at("case");
      html += "<tr><th scope=\"rowgroup\" colspan=\"" + std::to_string(columns) + "\">" +
              escaped(in.get<std::string>()) + "</th></tr>";
    }
    html += "<tr>";
    for (const auto& [key, value] : run.at("settings").items()) html += cell(text_of(value));
    html += cell(error(run.at("error_m")), true) + cell(error(run.at("least_error")), true) +
            cell(error(run.at("most_error")), true) +
            cell(std::to_string(run.at("count").get<std::size_t>()), true) +
            cell(rounded(run.at("seconds")), true);
    for (const std::string& stage : stages) {
      const ordered_json cost = run.at("stages").value(stage, ordered_json::object());
      html += cell(rounded(cost.value("seconds", ordered_json())), true);
    }
    const std::string trouble = run.at("trouble").get<std::string>();
    html += cell(rounded(peak_mib(run)), true) +
            cell(!trouble.empty()                 ? trouble
                 : run.at("on_front").get<bool>() ? "yes"
                                                  : "") +
            "</tr>";
  }
  return html + "</table></div>";
}

std::string source_rows(const ordered_json& in, const std::string& unit, bool has_cases) {
  std::string html;
  for (const auto& source : in.at("sources")) {
    char share[32];
    std::snprintf(share, sizeof share, "%.0f %%", 100 * number(source.at("share")));
    html += "<tr>" + (has_cases ? cell(in.at("name").get<std::string>()) : "") +
            cell(source.at("source").get<std::string>()) + cell(share, true) +
            cell(readable_value(number(source.at("error_m")), unit), true) + "</tr>";
  }
  return html;
}

std::string source_table(const ordered_json& cases, const std::string& unit) {
  std::string rows;
  for (const auto& in : cases) rows += source_rows(in, unit, cases.size() > 1);
  if (rows.empty()) return "";
  return "<h3>Where the error comes from</h3><p>Runs of the advised settings with the same random "
         "streams, spared one source after another.</p><div class=\"wide\" "
         "tabindex=\"0\"><table><tr>" +
         std::string(cases.size() > 1 ? "<th>case</th>" : "") +
         "<th>source</th><th class=\"number\">share of the mean square</th>"
         "<th class=\"number\">error</th></tr>" +
         rows + "</table></div>";
}

std::string plot_of(const ordered_json& tradeoff) {
  return tradeoff_plot(marks_of(tradeoff),
                       {.figure = tradeoff.at("figure").get<std::string>(),
                        .unit = tradeoff.at("unit").get<std::string>(),
                        .seconds = tradeoff.at("seconds").get<std::string>()},
                       number(tradeoff.at("tolerance")));
}

}  // namespace

std::string tradeoff_parts(const ordered_json& tradeoff) {
  const std::string unit = tradeoff.at("unit").get<std::string>();
  std::string html;
  for (const auto& in : tradeoff.at("cases"))
    html +=
        "<p><strong>" + escaped(in.at("advice").at("text").get<std::string>()) + "</strong></p>";
  html +=
      "<p>Filled marks are the front: nothing tried is both better and faster. A ring is the "
      "advice. Lines go through what each curve can at best for so many seconds; bars reach from "
      "the least to the most of the seeds. " +
      std::to_string(tradeoff.at("threads").get<int>()) + " threads, " +
      escaped(tradeoff.at("machine").get<std::string>()) + ".</p>";
  return html + plot_of(tradeoff) + source_table(tradeoff.at("cases"), unit) +
         run_table(tradeoff, unit);
}

std::string tradeoff_page(const std::string& title, const ordered_json& tradeoff) {
  const std::string whole = title + ": what accuracy costs";
  return page_head(whole) + "<h1>" + escaped(whole) + "</h1><p class=\"quiet\">libscan " +
         version_text() + "</p><main>" + tradeoff_parts(tradeoff) + "</main></body></html>\n";
}

std::string tradeoff_picture(const ordered_json& tradeoff) {
  return plot_of(tradeoff) + "\n";
}

}  // namespace scan
