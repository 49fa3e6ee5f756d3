// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/effect_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "libscan/acquire/depth_edges.h"
#include "synth/effects/thin.h"
#include "synth/ray_caster.h"

namespace scan {
namespace {

using synth::Effect;
using synth::EffectSet;

constexpr int first_look = 4;  // repeats; of points that never move in them at most 3 in 4 n would
constexpr std::uint64_t most_paths = 40'000'000;  // until which undecided points call for more
constexpr double decided_share = 0.95;
// Renderers leave out by themselves what does not pay: the phase camera 0.07 sigma by sub-rays, the
// laser line 0.1 by paths (see their render()).
constexpr double spared_sigma = 0.1;

// Decoders are not continuous: readings are rounded, windows end at whole samples, and what carries
// one over an end moves a point by some hundredths of its sigma, however small it is. Read noise of
// half a step or more, the same in both scans of a pair, lets such steps fall on few of the pairs,
// which their median passes over, and makes the mean of rounded readings what it would be without
// rounding (to 2 exp(-pi^2 / 2) of a step over pi, Widrow 1961).
enum class Dither { off, on };

// How many rays are checked: of a laser line each step takes a whole image, and a stereo pair's
// windows need some rows.
double checked_rays(const synth::LaserLine&) {
  return 300;
}
double checked_rays(const synth::StereoPair& pair) {
  return 32.0 * pair.calibration.width_px;
}
double checked_rays(const synth::PhaseCamera&) {
  return 1200;
}
double checked_rays(const synth::PulsedLidar&) {
  return 400;
}

struct Result {
  Scan scan;
  std::uint64_t paths = 0;
};

class Check {
 public:
  explicit Check(const Recipe& recipe)
      : recipe_(recipe),
        view_(synth::true_poses(recipe.viewpoints).front()),
        plan_(synth::plan_effects(recipe.scanner, recipe.scene.scene,
                                  synth::true_poses(recipe.viewpoints), recipe.effects)),
        chosen_(synth::effects_of(plan_)),
        scanner_(thinned()) {}

  const synth::EffectPlan& plan() const { return plan_; }
  const EffectSet& chosen() const { return chosen_; }
  // Without dither, which takes fewer scans, if that is enough.
  EffectComparison compare(const std::string& effect, const EffectBound& bound,
                           const EffectSet& effects, double spared);

 private:
  synth::Scanner thinned() const;
  bool is_stereo() const { return std::holds_alternative<synth::StereoPair>(scanner_); }
  EffectSet quiet(const EffectSet& effects, Dither dither) const;
  Result simulate(const EffectSet& effects, int repeat, Dither dither) const;
  const Result& planned(int repeat, Dither dither);
  bool has_chance(const EffectSet& effects, Dither dither) const;
  PairedScans start() const;
  EffectComparison compare(const std::string& effect, const EffectBound& bound,
                           const EffectSet& effects, double spared, Dither dither);

  const Recipe& recipe_;
  Pose view_;
  synth::EffectPlan plan_;
  EffectSet chosen_;
  synth::Scanner scanner_;
  std::map<Dither, std::vector<Result>> planned_;  // by repeat
};

// A phase camera is thinned by larger pixels, a pair by fewer rows.
synth::Scanner Check::thinned() const {
  const auto* camera = std::get_if<synth::PhaseCamera>(&recipe_.scanner);
  if (camera && camera->sub_rays > 1 && !chosen_.has(Effect::footprint))
    return recipe_.scanner;  // how large its pixels are is the question
  const double rays = std::visit([](const auto& s) { return checked_rays(s); }, recipe_.scanner);
  return synth::thinned(recipe_.scanner, rays);
}

EffectSet Check::quiet(const EffectSet& effects, Dither dither) const {
  EffectSet set = effects.without(Effect::shot_noise);
  set.set(Effect::read_noise, dither == Dither::on);
  if (chosen_.has(Effect::quantisation)) set.set(Effect::quantisation, false);
  return set;
}

synth::Scanner dithered(synth::Scanner scanner) {
  std::visit(
      [](auto& s) {
        s.sensor.read_noise_e = std::max(s.sensor.read_noise_e, s.sensor.gain_e_per_dn / 2);
      },
      scanner);
  return scanner;
}

Result Check::simulate(const EffectSet& effects, int repeat, Dither dither) const {
  const EffectSet set = quiet(effects, dither);
  const synth::RayCaster caster(synth::simplified(recipe_.scene.scene, set));
  const synth::Rendering rendering =
      synth::render(dither == Dither::on ? dithered(scanner_) : scanner_, caster, view_,
                    {.seed = recipe_.seed, .scan = static_cast<std::uint32_t>(repeat)}, set);
  return {acquire(rendering.frames, recipe_.acquire), rendering.statistics.paths};
}

const Result& Check::planned(int repeat, Dither dither) {
  std::vector<Result>& results = planned_[dither];
  while (static_cast<int>(results.size()) <= repeat)
    results.push_back(simulate(chosen_, static_cast<int>(results.size()), dither));
  return results[static_cast<std::size_t>(repeat)];
}

// Besides that of light's paths.
bool Check::has_chance(const EffectSet& effects, Dither dither) const {
  if (dither == Dither::on) return true;
  const auto* laser = std::get_if<synth::LaserLine>(&scanner_);
  return laser && laser->speckle_contrast > 0 && effects.has(Effect::speckle);
}

PairedScans Check::start() const {
  const auto* pair = std::get_if<synth::StereoPair>(&scanner_);
  if (!pair) return {{}, nullptr};
  const StereoCalibration& c = pair->calibration;
  Image<float> disparity(c.width_px, c.height_px);
  const std::vector<RayTruth> rays =
      synth::true_rays(scanner_, synth::RayCaster(recipe_.scene.scene), view_);
  for (std::size_t i = 0; i < rays.size(); ++i)  // NaN where there is nothing
    disparity.pixels[i] =
        static_cast<float>(c.focal_px * c.baseline_m / rays[i].point_in_scanner.z() - c.doffs_px);
  return {decoding::near_depth_edge(disparity, recipe_.acquire.stereo.block_px), &c};
}

EffectComparison Check::compare(const std::string& effect, const EffectBound& bound,
                                const EffectSet& effects, double spared) {
  if (is_stereo()) return compare(effect, bound, effects, spared, Dither::on);  // 8 bits are coarse
  const EffectComparison quiet = compare(effect, bound, effects, spared, Dither::off);
  if (quiet.pass) return quiet;
  EffectComparison result = compare(effect, bound, effects, spared, Dither::on);
  if (result.resolution_sigma > matters_sigma)
    result.pass = false;  // too coarse to excuse anything
  return result;
}

EffectComparison Check::compare(const std::string& effect, const EffectBound& bound,
                                const EffectSet& effects, double spared, Dither dither) {
  PairedScans pairs = start();
  std::uint64_t paths = 0;
  const auto add = [&] {
    const Result fuller = simulate(effects, pairs.repeats(), dither);
    const Result& by_plan = planned(pairs.repeats(), dither);
    pairs.add(by_plan.scan, fuller.scan);
    paths += fuller.paths + by_plan.paths;
  };
  add();
  if (paths == 0 && !has_chance(effects, dither)) return pairs.judge(effect, bound, spared, true);
  while (pairs.repeats() < first_look && pairs.identical()) add();
  if (pairs.identical()) return pairs.judge(effect, bound, spared, true);
  for (int look = 1;; look *= 2) {
    const int repeats = look * pairs.least_repeats() * 5 / 4;  // a point may miss some
    while (pairs.repeats() < repeats) add();
    const EffectComparison result = pairs.judge(effect, bound, spared, false);
    const double open = static_cast<double>(result.undecided + result.unsteady);
    const bool decided =
        open <= (1 - decided_share) * static_cast<double>(result.points + result.unsteady);
    if (decided || look == 4 || 2 * paths > most_paths) return result;
  }
}

bool is_noise(Effect effect) {
  return effect == Effect::shot_noise || effect == Effect::read_noise;
}

}  // namespace

std::vector<EffectComparison> check_plan(const Recipe& recipe) {
  Check check(recipe);
  std::vector<EffectComparison> comparisons;
  EffectBound all;
  for (const synth::EffectDecision& decision : check.plan()) {
    if (decision.on || is_noise(decision.effect) || !(decision.bound_m > 0)) continue;
    const EffectBound bound{decision.bound_m, decision.bound_sigma};
    all = {all.range_m + bound.range_m, all.sigmas + bound.sigmas};
    comparisons.push_back(check.compare(std::string(synth::name(decision.effect)), bound,
                                        EffectSet(check.chosen()).set(decision.effect), 0));
  }
  comparisons.push_back(check.compare("all", all, EffectSet::all(), spared_sigma));
  return comparisons;
}

bool all_pass(const std::vector<EffectComparison>& comparisons) {
  return std::all_of(comparisons.begin(), comparisons.end(),
                     [](const EffectComparison& c) { return c.pass; });
}

void say(const std::vector<EffectComparison>& comparisons, const Console& console) {
  for (const EffectComparison& c : comparisons) {
    char text[240];
    std::snprintf(text, sizeof text,
                  "  with %-18s of at most %s (%.3g sigma): %zu points, %zu beyond it, worst by %s "
                  "(%.1f of %.1f standard errors); bias %+.4f sigma (%+.4f to %+.4f), %s",
                  c.effect.c_str(), readable_length(c.bound.range_m).c_str(), c.bound.sigmas,
                  c.points, c.beyond, readable_length(c.excess_m).c_str(), c.excess_errors,
                  c.limit_errors, c.bias_sigma, c.bias_low_sigma, c.bias_high_sigma,
                  c.pass ? "pass" : "FAIL");
    console.say(text);
    std::snprintf(
        text, sizeof text,
        "    surely moved: %.3g sigma; %d pairs of scans resolve %.2g sigma, undecided: %zu "
        "points; not judged: %zu that jump at depth edges, %zu seldom in both, %zu never",
        c.moved_sigma, c.repeats, c.resolution_sigma, c.undecided, c.at_edges, c.unsteady, c.lost);
    console.say(text);
    if (c.undecided == 0) continue;
    std::snprintf(
        text, sizeof text,
        "    the %zu undecided points are not proven one by one: the bias proves them, with "
        "the others, in the mean alone",
        c.undecided);
    console.say(text);
  }
}

nlohmann::ordered_json to_json(const std::vector<EffectComparison>& comparisons) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const EffectComparison& c : comparisons)
    list.push_back({{"effect", c.effect},
                    {"bound_m", c.bound.range_m},
                    {"bound_sigma", c.bound.sigmas},
                    {"repeats", c.repeats},
                    {"points", c.points},
                    {"beyond", c.beyond},
                    {"undecided", c.undecided},
                    {"lost", c.lost},
                    {"unsteady", c.unsteady},
                    {"at_edges", c.at_edges},
                    {"excess_m", c.excess_m},
                    {"excess_errors", c.excess_errors},
                    {"limit_errors", c.limit_errors},
                    {"resolution_sigma", c.resolution_sigma},
                    {"moved_sigma", c.moved_sigma},
                    {"bias_sigma", c.bias_sigma},
                    {"bias_low_sigma", c.bias_low_sigma},
                    {"bias_high_sigma", c.bias_high_sigma},
                    {"pass", c.pass}});
  return list;
}

}  // namespace scan
