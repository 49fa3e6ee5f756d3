// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/study_runs.h"

#include <cmath>
#include <limits>

#include "libscan/core/cost.h"
#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_output.h"
#include "libscan/io/poses.h"
#include "libscan/io/truth_file.h"
#include "tools/run_files.h"
#include "tools/run_stages.h"

namespace scan {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// The parts of a recipe that decide each stage, beyond those of the stages before it.
struct StageOf {
  const char* name;
  std::vector<const char*> decided_by;
  std::vector<const char*> outputs;
};
const std::vector<StageOf> study_stages = {
    {"simulate",
     {"seed", "scene", "scanner", "viewpoints", "effects", "acquire"},
     {"effects.json", "simulation.json", "timings.json", "scans", "truth"}},
    {"align", {"align"}, {"alignment.json", "poses.tum"}},
    {"reconstruct", {"reconstruct"}, {"surface.ply", "reconstruction.json"}}};

// Files are never changed in place, so runs may share them.
void link_outputs(const fs::path& from, const fs::path& to, const std::vector<const char*>& names) {
  for (const char* name : names)
    if (fs::exists(from / name))
      fs::copy(from / name, to / name,
               fs::copy_options::recursive | fs::copy_options::create_hard_links);
}

void write_true_poses(const fs::path& run) {
  const Truth truth = read_truth(truth_path(run));
  std::vector<NamedPose> poses;
  for (std::size_t i = 0; i < truth.scans.size(); ++i)
    poses.push_back({scan_name(i), truth.scans[i].world_from_scanner});
  write_poses_tum(run / "poses.tum", poses);
}

const Measurement& figure_of(const Verdict& verdict, const std::string& name) {
  for (const Measurement& measurement : verdict.measurements)
    if (measurement.name == name) return measurement;
  throw Error(Trouble::input, "tradeoff/error: \"" + name + "\" is no figure of a verdict",
              "`scan run` lists them");
}

ordered_json outcome_json(const RunOutcome& outcome, const std::string& as_run) {
  return {
      {"run", fingerprint(as_run)},
      {"error", std::isfinite(outcome.error) ? ordered_json(outcome.error) : ordered_json(nullptr)},
      {"unit", outcome.unit},
      {"seconds", outcome.seconds},
      {"trouble", outcome.trouble}};
}

RunOutcome outcome_of(const ordered_json& json) {
  const bool known = json.at("error").is_number();
  return {
      .error = known ? json.at("error").get<double>() : std::numeric_limits<double>::quiet_NaN(),
      .unit = json.at("unit").get<std::string>(),
      .seconds = json.at("seconds").get<std::map<std::string, double>>(),
      .trouble = json.at("trouble").get<std::string>()};
}

}  // namespace

double RunOutcome::total_s() const {
  double sum = 0;
  for (const auto& [stage, s] : seconds) sum += s;
  return sum;
}

StudyRuns::StudyRuns(std::string place, fs::path folder, fs::path out)
    : place_(std::move(place)), folder_(std::move(folder)), runs_(std::move(out) / "runs") {
  make_folder(runs_);
}

void StudyRuns::stages(const fs::path& run, const Recipe& recipe, const Spared& spared,
                       Console& console, std::map<std::string, double>& seconds) {
  const ordered_json json = to_json(recipe);
  std::string decided;
  for (const StageOf& stage : study_stages) {
    for (const char* part : stage.decided_by) decided += json.at(part).dump();
    if (stage.name == std::string("align") && spared.poses) decided += "true poses";
    const std::string key = stage.name + fingerprint(decided);
    if (const auto found = done_.find(key); found != done_.end()) {
      link_outputs(found->second.run, run, stage.outputs);
      seconds.insert(found->second.seconds.begin(), found->second.seconds.end());
      continue;
    }
    const Stopwatch watch;
    if (stage.name == std::string("simulate"))
      simulate_run(run, recipe, {}, console);
    else if (stage.name == std::string("align"))
      spared.poses ? write_true_poses(run) : align_run(run, recipe, console);
    else
      reconstruct_run(run, recipe, console);
    std::map<std::string, double> took = {{stage.name, watch.seconds()}};
    if (stage.name == std::string("simulate")) {
      took["acquire"] = console.seconds().at("acquire");
      took["simulate"] -= took["acquire"];
    }
    seconds.insert(took.begin(), took.end());
    done_[key] = {run, took};
  }
}

RunOutcome StudyRuns::run(const std::string& name, const nlohmann::json& json, std::uint64_t seed,
                          const std::string& figure, const Spared& spared) {
  Recipe recipe = read_recipe(json, place_, folder_);
  recipe.seed = seed;
  recipe.limits.clear();
  if (spared.effects) recipe.effects = {synth::EffectChoice::Kind::none, {}};
  const std::string as_run = json_text(to_json(recipe));
  const std::string key = as_run + figure + (spared.poses ? " with true poses" : "");
  const fs::path run = runs_ / name, result = run / "outcome.json";
  if (fs::exists(result)) {
    const ordered_json stored = ordered_json::parse(read_file(result), nullptr, false);
    if (!stored.is_discarded() && stored.value("run", "") == fingerprint(key))
      return outcome_of(stored);
  }
  fs::remove_all(run);
  make_folder(run);
  write_file(recipe_path(run), as_run);
  RunOutcome outcome{
      .error = std::numeric_limits<double>::quiet_NaN(), .unit = {}, .seconds = {}, .trouble = {}};
  Console console;
  console.quiet = true;
  try {
    stages(run, recipe, spared, console, outcome.seconds);
    const Verdict verdict = verify_run(run, console);
    outcome.error = figure_of(verdict, figure).value;
    outcome.unit = figure_of(verdict, figure).unit;
  } catch (const Error& error) {
    if (error.trouble() == Trouble::input || error.trouble() == Trouble::output) throw;
    outcome.trouble = error.what();
  }
  write_json(result, outcome_json(outcome, key));
  return outcome;
}

}  // namespace scan
