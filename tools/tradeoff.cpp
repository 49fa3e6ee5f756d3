// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan tradeoff: a recipe's settings varied, error against seconds, and what to choose.
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_output.h"
#include "tools/commands.h"
#include "tools/report/tradeoff_page.h"
#include "tools/study_runs.h"
#include "tools/study_search.h"
#include "tools/version.h"

namespace scan {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct Arguments {
  std::string recipe, out;
  std::string search = "grid";
  double tolerance = 0;
  bool resume = false, force = false;
};

std::string setting_text(const Study& study, const Setting& setting) {
  const ordered_json json = setting_json(study, setting);
  std::string text;
  for (const auto& [key, value] : json.items())
    text += (text.empty() ? "" : ", ") + key + " " +
            (value.is_string() ? value.get<std::string>() : value.dump());
  return text;
}

std::string run_name(const Setting& setting, int seed, const std::string& spared = "") {
  std::string name;
  for (const std::size_t index : setting) name += std::to_string(index) + "-";
  return name + "seed" + std::to_string(seed) + spared;
}

// The study at work: settings run seed by seed, with the time that is left.
class Work {
 public:
  Work(const Arguments& arguments, Console& console)
      : console_(console), recipe_(read_json(arguments.recipe)) {
    const Recipe checked = read_recipe(arguments.recipe);
    if (!recipe_.contains("tradeoff"))
      throw Error(Trouble::input, arguments.recipe + ": has no tradeoff",
                  "give it \"tradeoff\": { \"vary\": [ { \"key\": \"reconstruct/depth\", "
                  "\"values\": [6, 7, 8] } ] }");
    study_ = read_study(JsonReader(recipe_.at("tradeoff"), arguments.recipe + "/tradeoff"));
    seed_ = checked.seed;
    name_ = checked.name;
    recipe_.erase("tradeoff");
    runs_.emplace(arguments.recipe, fs::path(arguments.recipe).parent_path(),
                  fs::path(arguments.out));
    total_ = grid(study_).size() * static_cast<std::size_t>(study_.seeds);
  }

  const Study& study() const { return study_; }
  const std::string& name() const { return name_; }
  std::size_t runs_done() const { return done_; }
  std::size_t runs_of_grid() const { return total_; }

  StudyPoint measure(const Setting& setting, int seeds) {
    const nlohmann::json recipe = with_setting(recipe_, study_, setting);
    StudyPoint point{.setting = setting,
                     .least_error = std::numeric_limits<double>::infinity(),
                     .most_error = -std::numeric_limits<double>::infinity()};
    for (int i = 0; i < seeds; ++i) {
      const RunOutcome outcome = run_one(setting, recipe, i, {});
      add(point, outcome);
    }
    point.error /= seeds;
    point.seconds /= seeds;
    for (auto& [stage, s] : point.stage_seconds) s /= seeds;
    return point;
  }

  // The mean square of the error over the seeds, spared some of its sources.
  double mean_square(const Setting& setting, const Spared& spared) {
    double sum = 0;
    for (int i = 0; i < study_.seeds; ++i) {
      const double error =
          run_one(setting, with_setting(recipe_, study_, setting), i, spared).error;
      sum += error * error;
    }
    return sum / study_.seeds;
  }

 private:
  static void add(StudyPoint& point, const RunOutcome& outcome) {
    ++point.runs;
    point.error += outcome.error;
    point.least_error = std::min(point.least_error, outcome.error);
    point.most_error = std::max(point.most_error, outcome.error);
    point.seconds += outcome.total_s();
    for (const auto& [stage, s] : outcome.seconds) point.stage_seconds[stage] += s;
    if (point.trouble.empty()) point.trouble = outcome.trouble;
    if (point.unit.empty()) point.unit = outcome.unit;
  }

  RunOutcome run_one(const Setting& setting, const nlohmann::json& recipe, int seed,
                     const Spared& spared) {
    const std::string suffix =
        std::string(spared.poses ? "-true-poses" : "") + (spared.effects ? "-no-effects" : "");
    const RunOutcome outcome =
        runs_->run(run_name(setting, seed, suffix), recipe,
                   seed_ + static_cast<std::uint64_t>(seed), study_.error, spared);
    ++done_;
    console_.log(
        "run " + std::to_string(done_) + ": " + setting_text(study_, setting) + suffix + ", seed " +
        std::to_string(seed_ + static_cast<std::uint64_t>(seed)) + ": " +
        (outcome.trouble.empty() ? readable_value(outcome.error, outcome.unit) : outcome.trouble) +
        left());
    return outcome;
  }

  // At the mean pace so far; the grid is the most there may be.
  std::string left() const {
    if (done_ >= total_) return "";
    char text[64];
    const double each_s = watch_.seconds() / static_cast<double>(done_);
    std::snprintf(text, sizeof text, "; at most %.0f s left",
                  each_s * static_cast<double>(total_ - done_));
    return text;
  }

  Console& console_;
  nlohmann::json recipe_;
  Study study_;
  std::uint64_t seed_ = 1;
  std::string name_;
  std::optional<StudyRuns> runs_;
  std::size_t done_ = 0, total_ = 0;
  Stopwatch watch_;
};

ordered_json point_json(const Study& study, const StudyPoint& point) {
  const auto number = [&](double value) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
  };
  return {{"settings", setting_json(study, point.setting)},
          {"error_m", number(point.error)},
          {"least_error", number(point.least_error)},
          {"most_error", number(point.most_error)},
          {"count", point.runs},
          {"seconds", point.seconds},
          {"stage_seconds", point.stage_seconds},
          {"on_front", point.on_front},
          {"trouble", point.trouble}};
}

// Shares of the mean square, by sparing one source after another: poses first, then what the
// scanner does; the rest is the surface's own.
ordered_json sources_json(Work& work, const Setting& setting) {
  const double all = work.mean_square(setting, {});
  const double posed = work.mean_square(setting, {.poses = true});
  const double ideal = work.mean_square(setting, {.poses = true, .effects = true});
  if (!(all > 0) || !std::isfinite(posed) || !std::isfinite(ideal)) return ordered_json::array();
  ordered_json list = ordered_json::array();
  const auto add = [&](const char* source, double square) {
    const double kept = std::max(0.0, square);
    list.push_back({{"source", source}, {"share", kept / all}, {"error_m", std::sqrt(kept)}});
  };
  add("registration", all - posed);
  add("the scanner's noise and effects", posed - ideal);
  add("reconstruction and sampling", ideal);
  return list;
}

std::string tenths(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", seconds);
  return text;
}

ordered_json advice_json(const Work& work, const std::vector<StudyPoint>& points,
                         std::optional<std::size_t> chosen, double tolerance,
                         const ordered_json& sources, std::size_t runs_tried) {
  if (!chosen) return {{"text", "Every run failed: " + points.front().trouble}, {"meets", false}};
  const StudyPoint& point = points[*chosen];
  const bool meets = tolerance > 0 && point.error <= tolerance;
  const std::string figure = work.study().error, unit = point.unit;
  std::string text = setting_text(work.study(), point.setting) + ": " + figure + " " +
                     readable_value(point.error, unit) + " in " + tenths(point.seconds) + " s";
  text += meets ? ", the cheapest of those tried within " + readable_value(tolerance, unit)
          : tolerance > 0
              ? ", the best of those tried; none is within " + readable_value(tolerance, unit)
              : ", the most accurate of those tried";
  std::string largest;
  double share = 0;
  for (const auto& source : sources)
    if (source.at("share").get<double>() > share) {
      share = source.at("share").get<double>();
      largest = source.at("source").get<std::string>();
    }
  if (!largest.empty()) text += ". Most of its error comes from " + largest;
  return {{"text", text + "."},
          {"meets", meets},
          {"settings", setting_json(work.study(), point.setting)},
          {"runs", runs_tried},
          {"runs_of_grid", work.runs_of_grid()}};
}

void open_study(const Arguments& arguments) {
  const fs::path out = arguments.out;
  if (fs::exists(out / "runs") && !arguments.resume && !arguments.force)
    throw Error(Trouble::output, arguments.out + ": holds an earlier study",
                "--resume goes on with it, --force replaces it");
  if (arguments.force) {
    fs::remove_all(out / "runs");
    fs::remove(out / "tradeoff.json");
    fs::remove(out / "tradeoff.html");
  }
}

int tradeoff(const Arguments& arguments, Console& console) {
  open_study(arguments);
  Work work(arguments, console);
  const Measure measure = [&](const Setting& setting, int seeds) {
    return work.measure(setting, seeds);
  };
  const auto points = arguments.search == "grid"
                          ? search_grid(work.study(), measure)
                          : search_adaptively(work.study(), arguments.tolerance, measure);
  const auto chosen = advised(points, arguments.tolerance);
  const std::size_t runs_tried = work.runs_done();  // before those that tell the sources apart
  ordered_json runs = ordered_json::array();
  for (const StudyPoint& point : points) runs.push_back(point_json(work.study(), point));
  const ordered_json sources =
      chosen ? sources_json(work, points[*chosen].setting) : ordered_json::array();
  const ordered_json advice =
      advice_json(work, points, chosen, arguments.tolerance, sources, runs_tried);
  const ordered_json json = {{"figure", work.study().error},
                             {"unit", chosen ? points[*chosen].unit : "m"},
                             {"tolerance", arguments.tolerance},
                             {"search", arguments.search},
                             {"machine", machine_text()},
                             {"threads", thread_count()},
                             {"runs", runs},
                             {"sources", sources},
                             {"advice", advice}};
  const fs::path out = arguments.out;
  write_json(out / "tradeoff.json", json);
  write_file(out / "tradeoff.html", tradeoff_page(work.name(), json));
  console.say(advice.at("text").get<std::string>());
  console.say((out / "tradeoff.html").string() + " shows the curve");
  if (!chosen) throw Error(Trouble::computation, advice.at("text").get<std::string>());
  const bool pass = arguments.tolerance == 0 || advice.at("meets").get<bool>();
  console.finish("tradeoff", pass ? "ok" : "failed", json);
  return pass ? 0 : 1;
}

}  // namespace

Action tradeoff_command(CommandLine& line) {
  auto arguments = std::make_shared<Arguments>();
  line.input("RECIPE", arguments->recipe, "an experiment (JSON) with a \"tradeoff\"");
  line.input("OUT", arguments->out, "the folder to write into");
  line.length("--tolerance", arguments->tolerance,
              "advise the cheapest settings whose error is within this");
  line.choice("--search", arguments->search, {"grid", "adaptive"},
              "try every setting, or only those on the way to the advice");
  line.flag("--resume", arguments->resume, "go on with an earlier study in OUT");
  line.flag("--force", arguments->force, "replace an earlier study in OUT");
  return [arguments](Console& console) { return tradeoff(*arguments, console); };
}

}  // namespace scan
