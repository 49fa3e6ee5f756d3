// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The first stage of a run: raw frames, scans, truth and the effect plan.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/json_output.h"
#include "libscan/io/raw_files.h"
#include "libscan/io/scan_file.h"
#include "libscan/io/truth_file.h"
#include "synth/effects/cost.h"
#include "synth/ray_caster.h"
#include "tools/run_files.h"
#include "tools/run_stages.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

ordered_json effects_json(const synth::EffectPlan& plan) {
  ordered_json list = ordered_json::array();
  for (const synth::EffectDecision& decision : plan)
    list.push_back({{"effect", std::string(synth::name(decision.effect))},
                    {"decision", decision.on ? "on" : "off"},
                    {"reason", decision.reason},
                    {"bound_m", decision.bound_m},
                    {"bound_sigma", decision.bound_sigma}});
  return list;
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(Trouble::output, folder.string() + ": " + error.message());
}

// What the whole simulation took and how near it came, besides the seconds.
struct Totals {
  double acquire_s = 0;
  std::uint64_t paths = 0;
  double sampling_error = 0;

  void add(const synth::RenderStatistics& statistics) {
    paths += statistics.paths;
    sampling_error = std::max(sampling_error, statistics.sampling_error_rms);
  }
};

Scan decode(std::size_t i, const RawFrames& frames, const Recipe& recipe, Totals& totals) {
  const Stopwatch watch;
  Scan scan = acquire(frames, recipe.acquire);
  totals.acquire_s += watch.seconds();
  if (scan.cloud.empty())
    throw Error(Trouble::computation,
                "scan " + scan_name(i) +
                    ": no ray gave a point; does the scanner see the object from this viewpoint?");
  scan.name = scan_name(i);
  return scan;
}

// The plan with its costs, which go into timings.json: they differ from run to run.
synth::EffectPlan plan_run(const std::filesystem::path& run, const Recipe& recipe,
                           const std::vector<Pose>& poses, Console& console) {
  const Stopwatch watch;
  const synth::Scene& scene = recipe.scene.scene;
  synth::EffectPlan plan = synth::plan_effects(recipe.scanner, scene, poses, recipe.effects);
  measure_costs(plan, recipe.scanner, scene, poses.front(), static_cast<int>(poses.size()));
  ordered_json costs = ordered_json::object();
  for (const synth::EffectDecision& decision : plan)
    costs[std::string(synth::name(decision.effect))] = decision.cost_s;
  write_json(run / "timings.json", {{"effects", costs}});
  console.time("plan", watch.seconds());
  write_json(run / "effects.json", effects_json(plan));
  return plan;
}

}  // namespace

void simulate_run(const std::filesystem::path& run, const Recipe& recipe,
                  const SimulateOptions& options, Console& console) {
  const Progress progress = console.progress();
  const auto poses = synth::true_poses(recipe.viewpoints);
  const auto guesses = synth::guessed_poses(recipe.viewpoints, recipe.seed);
  const synth::EffectSet effects = effects_of(plan_run(run, recipe, poses, console));
  const Stopwatch watch;
  Totals totals;
  const synth::RayCaster caster(simplified(recipe.scene.scene, effects));
  const synth::RayCaster measurable(without_clear_objects(recipe.scene.scene));
  make_folder(run / "scans");
  make_folder(truth_path(run));

  Truth truth{.surface = true_surface(measurable.scene()), .scans = {}};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    progress("simulate", static_cast<double>(i) / static_cast<double>(poses.size()));
    const auto [frames, statistics] =
        render(recipe.scanner, caster, poses[i],
               {.seed = recipe.seed, .scan = static_cast<std::uint32_t>(i)}, effects);
    totals.add(statistics);
    if (options.keep_raw) {
      make_folder(raw_path(run, i));
      write_raw_frames(raw_path(run, i), frames);
    }
    Scan scan = decode(i, frames, recipe, totals);
    scan.world_from_scanner_guess = guesses[i];
    write_scan(scan_path(run, i), scan);
    truth.scans.push_back(
        {scan_name(i), poses[i], true_rays(recipe.scanner, measurable, poses[i])});
  }
  progress("simulate", 1);
  write_truth(truth_path(run), truth);
  write_json(run / "simulation.json",
             {{"paths", totals.paths}, {"sampling_error", totals.sampling_error}});
  console.time("acquire", totals.acquire_s);
  console.time("simulate", watch.seconds() - totals.acquire_s);
}

}  // namespace scan
