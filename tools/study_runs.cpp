// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/study_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libscan/core/cost.h"
#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
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
    {"align", {"align"}, {"alignment.json", "pose_trace.json", "poses.tum"}},
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
  ordered_json stages = ordered_json::object();
  for (const auto& [stage, cost] : outcome.stages)
    stages[stage] = {{"seconds", cost.seconds},
                     {"processor_seconds", cost.processor_seconds},
                     {"peak_mib", cost.peak_mib}};
  return {
      {"run", fingerprint(as_run)},
      {"error", std::isfinite(outcome.error) ? ordered_json(outcome.error) : ordered_json(nullptr)},
      {"unit", outcome.unit},
      {"stages", stages},
      {"trouble", outcome.trouble}};
}

RunOutcome outcome_of(const ordered_json& json) {
  const bool known = json.at("error").is_number();
  RunOutcome outcome{
      .error = known ? json.at("error").get<double>() : std::numeric_limits<double>::quiet_NaN(),
      .unit = json.at("unit").get<std::string>(),
      .stages = {},
      .trouble = json.at("trouble").get<std::string>()};
  for (const auto& [stage, cost] : json.at("stages").items())
    outcome.stages[stage] = {cost.at("seconds").get<double>(),
                             cost.at("processor_seconds").get<double>(),
                             cost.at("peak_mib").get<double>()};
  return outcome;
}

// Both work in turn, scan by scan: of the processor's seconds each has its share of the wall's.
void part_acquire(double seconds, StageCosts& costs) {
  StageCost& whole = costs.at("simulate");
  const double processor_seconds = whole.processor_seconds * seconds / whole.seconds;
  whole.seconds -= seconds;
  whole.processor_seconds -= processor_seconds;
  costs["acquire"] = {seconds, processor_seconds, whole.peak_mib};
}

bool is_noise(synth::Effect effect) {
  using enum synth::Effect;
  return effect == shot_noise || effect == read_noise || effect == quantisation ||
         effect == speckle;
}

bool is_miscalibration(synth::Effect effect) {
  using enum synth::Effect;
  return effect == miscalibration || effect == plane_bow || effect == wiggling ||
         effect == range_walk;
}

// The effects that the recipe calls for, but those that are spared.
synth::EffectChoice left_over(const Recipe& recipe, const Spared& spared) {
  synth::EffectChoice left{synth::EffectChoice::Kind::named, {}};
  for (const synth::EffectDecision& decision :
       synth::plan_effects(recipe.scanner, recipe.scene.scene, synth::true_poses(recipe.viewpoints),
                           recipe.effects)) {
    const bool is_spared = is_noise(decision.effect)            ? spared.noise
                           : is_miscalibration(decision.effect) ? spared.calibration
                                                                : spared.effects;
    if (decision.on && !is_spared) left.names.emplace_back(synth::name(decision.effect));
  }
  if (left.names.empty()) left.kind = synth::EffectChoice::Kind::none;
  return left;
}

}  // namespace

StudyRuns::StudyRuns(std::string place, fs::path folder, fs::path out)
    : place_(std::move(place)), folder_(std::move(folder)), runs_(std::move(out) / "runs") {}

void StudyRuns::do_stages(const fs::path& run, const Recipe& recipe, const Spared& spared,
                          Console& console, StageCosts& costs) {
  const ordered_json json = to_json(recipe);
  std::string decided = std::to_string(thread_count()) + " threads";
  for (const StageOf& stage : study_stages) {
    for (const char* part : stage.decided_by) decided += json.at(part).dump();
    if (stage.name == std::string("align") && spared.poses) decided += "true poses";
    const std::string key = stage.name + fingerprint(decided);
    if (const auto found = done_.find(key); found != done_.end()) {
      link_outputs(found->second.run, run, stage.outputs);
      costs.insert(found->second.costs.begin(), found->second.costs.end());
      continue;
    }
    restart_peak_memory();
    const Stopwatch watch;
    const double begin_s = processor_seconds();
    if (stage.name == std::string("simulate"))
      simulate_run(run, recipe, {}, console);
    else if (stage.name == std::string("align"))
      spared.poses ? write_true_poses(run) : align_run(run, recipe, console);
    else
      reconstruct_run(run, recipe, console);
    StageCosts took = {
        {stage.name, {watch.seconds(), processor_seconds() - begin_s, peak_memory_mib()}}};
    if (stage.name == std::string("simulate")) part_acquire(console.seconds().at("acquire"), took);
    costs.insert(took.begin(), took.end());
    done_[key] = {run, took};
  }
}

Recipe StudyRuns::read(const StudyRecipe& recipe) const {
  return read_recipe(recipe.recipe, place_, folder_);
}

RunOutcome StudyRuns::run(const std::string& name, const StudyRecipe& study_recipe,
                          std::uint64_t seed, const std::string& figure, const Spared& spared) {
  Recipe recipe = read(study_recipe);
  recipe.seed = seed;
  recipe.limits.clear();
  if (spared.calibration || spared.effects || spared.noise)
    recipe.effects = left_over(recipe, spared);
  const ThreadLimit limit(study_recipe.threads > 0 ? study_recipe.threads : thread_count());
  const std::string as_run = json_text(to_json(recipe));
  const std::string key = "both clocks" + as_run + figure + std::to_string(thread_count()) +
                          (spared.poses ? " with true poses" : "");
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
      .error = std::numeric_limits<double>::quiet_NaN(), .unit = {}, .stages = {}, .trouble = {}};
  Console console;
  console.quiet = true;
  console.is_inner = true;
  try {
    do_stages(run, recipe, spared, console, outcome.stages);
    const Verdict verdict = verify_run(run, console);
    outcome.error = std::abs(figure_of(verdict, figure).value);  // a bias may be below 0
    outcome.unit = figure_of(verdict, figure).unit;
  } catch (const Error& error) {
    if (error.trouble() == Trouble::input || error.trouble() == Trouble::output) throw;
    outcome.trouble = error.what();
  }
  write_json(result, outcome_json(outcome, key));
  return outcome;
}

}  // namespace scan
