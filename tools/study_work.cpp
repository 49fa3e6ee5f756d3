// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/study_work.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

namespace fs = std::filesystem;

nlohmann::json read_study_recipe(const std::string& path) {
  nlohmann::json recipe = read_json(path);
  (void)read_recipe(path);
  if (!recipe.contains("tradeoff"))
    throw Error(Trouble::input, path + ": has no tradeoff",
                "give it \"tradeoff\": { \"vary\": [ { \"key\": \"reconstruct/depth\", "
                "\"values\": [6, 7, 8] } ] }");
  return recipe;
}

std::size_t index_of(const Study& study, const Case& in) {
  return static_cast<std::size_t>(&in - study.cases.data());
}

// "case1-0-2-seed0-true-poses"; a study without cases has no word for them.
std::string run_name(const Study& study, const Case& in, const Setting& setting, int seed,
                     const Spared& spared) {
  std::string name;
  if (!in.name.empty()) name += "case" + std::to_string(index_of(study, in)) + "-";
  for (const std::size_t index : setting) name += std::to_string(index) + "-";
  name += "seed" + std::to_string(seed);
  if (spared.poses) name += "-true-poses";
  if (spared.calibration) name += "-calibrated";
  if (spared.effects) name += "-no-effects";
  if (spared.noise) name += "-no-noise";
  return name;
}

std::string said(const Spared& spared) {
  std::string text;
  if (spared.poses) text = ", true poses";
  if (spared.calibration) text += ", calibrated";
  if (spared.effects) text += ", no effects";
  if (spared.noise) text += ", no noise";
  return text;
}

bool holds_any(const std::string& figure, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return figure.find(word) != std::string::npos; });
}

// What is spared one after another, and what is left when all is.
struct SparingSteps {
  std::vector<std::pair<std::string, Spared>> spared;
  std::string rest;
};

// True poses would leave nothing of a pose's error: there registration is what is left, as the
// decoding of exact signals is of a range's.
SparingSteps sparing_steps(const std::string& figure) {
  const bool of_poses = holds_any(
      figure, {"pose_error", "rotation_error", "translation_error", "registration_error"});
  const bool of_ranges = holds_any(figure, {"range_error", "ray_hit"});
  SparingSteps steps{.spared = {},
                     .rest = of_poses    ? "registration"
                             : of_ranges ? "decoding"
                                         : "reconstruction and sampling"};
  Spared spared{.poses = !of_poses && !of_ranges};
  if (spared.poses) steps.spared.emplace_back("registration", spared);
  spared.calibration = true;
  steps.spared.emplace_back("miscalibration", spared);
  spared.effects = true;
  steps.spared.emplace_back("effects of light and device", spared);
  spared.noise = true;
  steps.spared.emplace_back("noise", spared);
  return steps;
}

}  // namespace

std::string setting_text(const Study& study, const Setting& setting) {
  const nlohmann::ordered_json json = setting_json(study, setting);
  std::string text;
  for (const auto& [key, value] : json.items())
    text += (text.empty() ? "" : ", ") + key + " " +
            (value.is_string() ? value.get<std::string>() : value.dump());
  return text;
}

StudyWork::StudyWork(const std::string& recipe, const fs::path& out, Console& console)
    : console_(console),
      recipe_(read_study_recipe(recipe)),
      study_(read_study(JsonReader(recipe_.at("tradeoff"), recipe + "/tradeoff"))),
      runs_(recipe, fs::path(recipe).parent_path(), out) {
  recipe_.erase("tradeoff");
  for (const Case& in : study_.cases)
    for (const Setting& setting : grid(study_)) {
      const StudyRecipe given = with_setting(recipe_, study_, in, setting);
      if (given.threads > thread_count())
        throw Error(Trouble::input, recipe +
                                        "/tradeoff: threads: " + std::to_string(given.threads) +
                                        ", here are at most " + std::to_string(thread_count()));
      const Recipe checked = runs_.read(given);
      seed_ = checked.seed;
      name_ = checked.name;
      ++total_;
    }
  total_ *= static_cast<std::size_t>(study_.seeds);
}

StudyPoint StudyWork::measure(const Case& in, const Setting& setting, int seeds) {
  StudyPoint point{.setting = setting,
                   .least_error = std::numeric_limits<double>::infinity(),
                   .most_error = -std::numeric_limits<double>::infinity()};
  for (int i = 0; i < seeds; ++i) {
    const RunOutcome outcome = run(in, setting, i, {});
    ++point.runs;
    point.errors.push_back(outcome.error);
    point.seed_seconds.push_back(seconds_of(study_, outcome.stages));
    point.error += outcome.error / seeds;
    point.least_error = std::min(point.least_error, outcome.error);
    point.most_error = std::max(point.most_error, outcome.error);
    point.seconds += point.seed_seconds.back() / seeds;
    for (const auto& [stage, cost] : outcome.stages) {
      point.stages[stage].seconds += cost.seconds / seeds;
      point.stages[stage].processor_seconds += cost.processor_seconds / seeds;
      point.stages[stage].peak_mib = std::max(point.stages[stage].peak_mib, cost.peak_mib);
    }
    if (point.trouble.empty()) point.trouble = outcome.trouble;
    if (point.unit.empty()) point.unit = outcome.unit;
  }
  return point;
}

std::vector<ErrorSource> StudyWork::sources(const Case& in, const Setting& setting) {
  const SparingSteps steps = sparing_steps(study_.error);
  const double all = mean_square(in, setting, {});
  std::vector<ErrorSource> sources;
  const auto add = [&](const std::string& source, double square) {
    const double kept = std::max(0.0, square);
    sources.push_back({source, kept / all, std::sqrt(kept)});
  };
  double left = all;
  for (const auto& [source, spared] : steps.spared) {
    const double less = mean_square(in, setting, spared);
    if (!(all > 0) || !std::isfinite(less)) return {};
    if (less == left) continue;  // to the bit: there is no such source here
    add(source, left - less);
    left = less;
  }
  add(steps.rest, left);
  return sources;
}

RunOutcome StudyWork::run(const Case& in, const Setting& setting, int seed, const Spared& spared) {
  const std::string name = run_name(study_, in, setting, seed, spared);
  if (const auto found = outcomes_.find(name); found != outcomes_.end()) return found->second;
  const std::uint64_t run_seed = seed_ + static_cast<std::uint64_t>(seed);
  const RunOutcome outcome =
      runs_.run(name, with_setting(recipe_, study_, in, setting), run_seed, study_.error, spared);
  outcomes_[name] = outcome;
  ++done_;
  console_.log(
      "run " + std::to_string(done_) + ": " + (in.name.empty() ? "" : in.name + ": ") +
      setting_text(study_, setting) + said(spared) + ", seed " + std::to_string(run_seed) + ": " +
      (outcome.trouble.empty() ? readable_value(outcome.error, outcome.unit) : outcome.trouble) +
      time_left());
  return outcome;
}

// The mean over the seeds.
double StudyWork::mean_square(const Case& in, const Setting& setting, const Spared& spared) {
  double sum = 0;
  for (int i = 0; i < study_.seeds; ++i) {
    const double error = run(in, setting, i, spared).error;
    sum += error * error;
  }
  return sum / study_.seeds;
}

// At the mean pace so far; the grid is the most there may be.
std::string StudyWork::time_left() const {
  if (done_ >= total_) return "";
  char text[64];
  const double each_s = watch_.seconds() / static_cast<double>(done_);
  std::snprintf(text, sizeof text, "; at most %.0f s left",
                each_s * static_cast<double>(total_ - done_));
  return text;
}

}  // namespace scan
