// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The first stage of a run: raw frames, scans, truth and the effect plan.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_output.h"
#include "libscan/io/json_reader.h"
#include "libscan/io/raw_files.h"
#include "libscan/io/scan_file.h"
#include "libscan/io/truth_file.h"
#include "synth/effects/cost.h"
#include "synth/ray_caster.h"
#include "tools/run_files.h"
#include "tools/run_stages.h"

namespace scan {
namespace {

namespace fs = std::filesystem;
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

fs::path record_path(const fs::path& run, std::size_t i) {
  return run / "simulation" / (scan_name(i) + ".json");
}

fs::path seconds_path(const fs::path& run, std::size_t i) {
  return run / "timings" / (scan_name(i) + ".json");
}

fs::path rays_path(const fs::path& run, std::size_t i) {
  return truth_path(run) / (scan_name(i) + ".ply");
}

// Of a scan and its truth: a file that was cut short has fewer.
std::size_t bytes_of(const fs::path& run, std::size_t i) {
  return fs::file_size(scan_path(run, i)) + fs::file_size(rays_path(run, i));
}

// What one scan's simulation took and how near it came.
struct ScanRecord {
  std::uint64_t paths = 0;
  double sampling_error = 0;
  double simulate_s = 0, acquire_s = 0;
};

// The record comes behind all else of its scan, so a scan that has one is whole.
void write_record(const fs::path& run, std::size_t i, const std::string& inputs,
                  const ScanRecord& record) {
  write_json(seconds_path(run, i),
             {{"simulate", record.simulate_s}, {"acquire", record.acquire_s}});
  write_json(record_path(run, i), {{"inputs", inputs},
                                   {"paths", record.paths},
                                   {"sampling_error", record.sampling_error},
                                   {"bytes", bytes_of(run, i)}});
}

// None if the scan is not whole, or was made of other inputs.
std::optional<ScanRecord> read_record(const fs::path& run, std::size_t i,
                                      const std::string& inputs) {
  for (const fs::path& file :
       {record_path(run, i), seconds_path(run, i), scan_path(run, i), rays_path(run, i)})
    if (!fs::exists(file)) return std::nullopt;
  const nlohmann::json record = read_json(record_path(run, i));
  const nlohmann::json seconds = read_json(seconds_path(run, i));
  if (record.value("inputs", "") != inputs || record.value("bytes", 0ul) != bytes_of(run, i))
    return std::nullopt;
  return ScanRecord{record.value("paths", std::uint64_t{0}), record.value("sampling_error", 0.0),
                    seconds.value("simulate", 0.0), seconds.value("acquire", 0.0)};
}

Scan decode(std::size_t i, const RawFrames& frames, const Recipe& recipe) {
  Scan scan = acquire(frames, recipe.acquire);
  if (scan.cloud.empty())
    throw Error(Trouble::computation,
                "scan " + scan_name(i) +
                    ": no ray gave a point; does the scanner see the object from this viewpoint?");
  scan.name = scan_name(i);
  return scan;
}

// The plan with its costs, which go into timings.json: they differ from run to run.
synth::EffectPlan plan_run(const fs::path& run, const Recipe& recipe,
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

// A scene made ready for the rays of all scans.
struct Stage {
  const Recipe& recipe;
  const SimulateOptions& options;
  std::vector<Pose> poses;    // world_from_scanner
  std::vector<Pose> guesses;  // of them
  synth::EffectSet effects;
  synth::RayCaster caster;      // of what is rendered
  synth::RayCaster measurable;  // of what has a truth
};

// The first scan's guess is exact. None where the recipe lets all be exact, of turn or shift: that
// is no statement of a device.
std::optional<GuessSigma> sigma_of_guess(const synth::PoseNoise& noise, std::size_t scan) {
  if (!(noise.rotation_rad > 0 && noise.translation_m > 0)) return std::nullopt;
  if (scan == 0) return GuessSigma{};
  return GuessSigma{noise.rotation_rad, noise.translation_m};
}

void simulate_scan(const fs::path& run, std::size_t i, const Stage& stage) {
  ScanRecord record;
  const Stopwatch rendering;
  const auto [frames, statistics] =
      render(stage.recipe.scanner, stage.caster, stage.poses[i],
             {.seed = stage.recipe.seed, .scan = static_cast<std::uint32_t>(i)}, stage.effects);
  record.paths = statistics.paths;
  record.sampling_error = statistics.sampling_error_rms;
  if (stage.options.keep_raw) {
    make_folder(raw_path(run, i));
    write_raw_frames(raw_path(run, i), frames);
  }
  const Stopwatch decoding;
  Scan scan = decode(i, frames, stage.recipe);
  record.acquire_s = decoding.seconds();
  scan.world_from_scanner_guess = stage.guesses[i];
  scan.guess_sigma = sigma_of_guess(stage.recipe.viewpoints.pose_noise, i);
  write_scan(scan_path(run, i), scan);
  write_true_rays(truth_path(run), i,
                  true_rays(stage.recipe.scanner, stage.measurable, stage.poses[i]));
  record.simulate_s = rendering.seconds() - record.acquire_s;
  write_record(run, i, stage.options.inputs, record);
}

// What belongs to all scans together; false, and nothing is written, while one of them is missing.
bool complete(const fs::path& run, const Stage& stage, Console& console) {
  ScanRecord total;
  for (std::size_t i = 0; i < stage.poses.size(); ++i) {
    const auto record = read_record(run, i, stage.options.inputs);
    if (!record) return false;
    total.paths += record->paths;
    total.sampling_error = std::max(total.sampling_error, record->sampling_error);
    total.simulate_s += record->simulate_s;
    total.acquire_s += record->acquire_s;
  }
  write_true_scene(truth_path(run), true_surface(stage.measurable.scene()), stage.poses);
  write_json(run / "simulation.json",
             {{"paths", total.paths}, {"sampling_error", total.sampling_error}});
  console.time("acquire", total.acquire_s);
  console.time("simulate", total.simulate_s);
  return true;
}

}  // namespace

bool simulate_run(const fs::path& run, const Recipe& recipe, const SimulateOptions& options,
                  Console& console) {
  const Progress progress = console.progress();
  const auto poses = synth::true_poses(recipe.viewpoints);
  const synth::EffectSet effects = effects_of(plan_run(run, recipe, poses, console));
  const Stage stage{recipe,
                    options,
                    poses,
                    synth::guessed_poses(recipe.viewpoints, recipe.seed),
                    effects,
                    synth::RayCaster(simplified(recipe.scene.scene, effects)),
                    synth::RayCaster(without_clear_objects(recipe.scene.scene))};
  for (const fs::path& folder :
       {run / "scans", truth_path(run), run / "simulation", run / "timings"})
    make_folder(folder);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    progress("simulate", static_cast<double>(i) / static_cast<double>(poses.size()));
    const bool is_there = !options.inputs.empty() && read_record(run, i, options.inputs);
    if (holds(options.shard, i) && !is_there) simulate_scan(run, i, stage);
  }
  progress("simulate", 1);
  return complete(run, stage, console);
}

}  // namespace scan
