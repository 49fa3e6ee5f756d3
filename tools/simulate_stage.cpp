// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The first stage of a run: raw frames, scans, truth and the effect plan.
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/json_output.h"
#include "libscan/io/raw_files.h"
#include "libscan/io/scan_file.h"
#include "libscan/io/truth_file.h"
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
                    {"bound_sigma", decision.bound_sigma},
                    {"cost_s", decision.cost_s}});
  return list;
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(Trouble::output, folder.string() + ": " + error.message());
}

}  // namespace

void simulate_run(const std::filesystem::path& run, const Recipe& recipe,
                  const SimulateOptions& options, Console& console) {
  const Progress progress = console.progress();
  const Stopwatch watch;
  double acquire_seconds = 0;
  const auto poses = synth::true_poses(recipe.viewpoints);
  const synth::EffectPlan plan =
      synth::plan_effects(recipe.scanner, recipe.scene.scene, poses, recipe.effects);
  const synth::EffectSet effects = synth::effects_of(plan);
  const synth::RayCaster caster(synth::simplified(recipe.scene.scene, effects));
  const auto guesses = synth::guessed_poses(recipe.viewpoints, recipe.seed);
  make_folder(run / "scans");
  make_folder(truth_path(run));

  Truth truth{.surface = synth::true_surface(recipe.scene.scene), .scans = {}};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    progress("simulate", static_cast<double>(i) / static_cast<double>(poses.size()));
    const RawFrames frames =
        synth::render(recipe.scanner, caster, poses[i],
                      {.seed = recipe.seed, .scan = static_cast<std::uint32_t>(i)}, effects)
            .frames;
    if (options.keep_raw) {
      make_folder(raw_path(run, i));
      write_raw_frames(raw_path(run, i), frames);
    }
    const Stopwatch decoding;
    Scan scan = acquire(frames, recipe.acquire);
    acquire_seconds += decoding.seconds();
    if (scan.cloud.empty())
      throw Error(Trouble::computation, "scan " + scan_name(i) +
                                            ": no ray gave a point; does the "
                                            "scanner see the object from this viewpoint?");
    scan.name = scan_name(i);
    scan.world_from_scanner_guess = guesses[i];
    write_scan(scan_path(run, i), scan);
    truth.scans.push_back(
        {scan_name(i), poses[i], synth::true_rays(recipe.scanner, caster, poses[i])});
  }
  progress("simulate", 1);
  write_truth(truth_path(run), truth);
  write_json(run / "effects.json", effects_json(plan));
  console.time("acquire", acquire_seconds);
  console.time("simulate", watch.seconds() - acquire_seconds);
}

}  // namespace scan
