// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/effect_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <unordered_map>

#include "synth/effects/thin.h"
#include "synth/effects/weight.h"
#include "synth/ray_caster.h"

namespace scan {
namespace {

using synth::Effect;
using synth::EffectSet;

// Five standard errors: one in two million by chance.
constexpr double sampling_errors = 5;
constexpr double most_bias_sigma = 0.1;
constexpr double checked_rays = 1e4;

struct Result {
  Scan scan;
  double sampling_error = 0;  // of a reading, over its noise
};

// Two images of a stereo pair are rounded to 8 bits whatever is simulated: the share that this has
// in a reading's noise, at most. And a matcher jumps where there is next to no texture, by as much
// as it searches: one point in a hundred is not judged.
struct Chance {
  double rounding = 0;
  double judged_share = 1;
};

Chance chance_of(const synth::Scanner& scanner, const synth::Scene& scene, const Pose& view) {
  const auto* pair = std::get_if<synth::StereoPair>(&scanner);
  if (!pair) return {};
  const double step_e2 = pair->sensor.gain_e_per_dn * pair->sensor.gain_e_per_dn / 12;
  const double read_e2 = pair->sensor.read_noise_e * pair->sensor.read_noise_e;
  double most = 0;
  for (const synth::PilotRay& ray : pilot(*pair, synth::RayCaster(scene), view, 1000))
    most = std::max(most, std::sqrt(step_e2 / (ray.signal_e + read_e2 + step_e2)));
  return {.rounding = most, .judged_share = 0.99};
}

Result simulate_scan(const Recipe& recipe, const synth::Scanner& scanner, const Pose& view,
                     const EffectSet& effects) {
  const EffectSet quiet = effects.without(Effect::shot_noise).without(Effect::read_noise);
  const synth::RayCaster caster(synth::simplified(recipe.scene.scene, quiet));
  const synth::Rendering rendering =
      synth::render(scanner, caster, view, {.seed = recipe.seed, .scan = 0}, quiet);
  return {acquire(rendering.frames, recipe.acquire), rendering.statistics.sampling_error_max};
}

struct Difference {
  double range_m;
  double sampling_m;
};

void judge(std::vector<Difference>& differences, double judged_share, EffectComparison& result) {
  const auto excess = [&](const Difference& d) {  // over the bound, in what chance explains
    const double over_m = d.range_m - result.bound_m;
    return over_m > 0 ? over_m / std::max(d.sampling_m, 1e-300) : over_m;
  };
  std::sort(differences.begin(), differences.end(),
            [&](const Difference& a, const Difference& b) { return excess(a) < excess(b); });
  differences.resize(
      static_cast<std::size_t>(std::ceil(judged_share * static_cast<double>(differences.size()))));
  if (differences.empty()) return;
  result.difference_m = differences.back().range_m;
  result.sampling_m = differences.back().sampling_m;
  result.pass = result.difference_m <= result.bound_m + result.sampling_m;
}

EffectComparison compare(const std::string& effect, double bound_m, const Result& planned,
                         const Result& fuller, const Chance& chance) {
  EffectComparison result{.effect = effect, .bound_m = bound_m};
  std::unordered_map<std::uint32_t, std::size_t> planned_point;
  for (std::size_t i = 0; i < planned.scan.ray.size(); ++i) planned_point[planned.scan.ray[i]] = i;
  const double noise_share =
      sampling_errors * std::hypot(planned.sampling_error, fuller.sampling_error,
                                   std::numbers::sqrt2 * chance.rounding);
  double bias = 0;
  std::vector<Difference> differences;
  for (std::size_t j = 0; j < fuller.scan.ray.size(); ++j) {
    const auto found = planned_point.find(fuller.scan.ray[j]);
    if (found == planned_point.end()) continue;
    const Eigen::Vector3d& before = planned.scan.cloud.points[found->second];
    const Eigen::Vector3d change = fuller.scan.cloud.points[j] - before;
    const double sigma_m = planned.scan.cloud.sigma_m[found->second];
    ++result.rays;
    bias += std::copysign(change.norm(), change.dot(before)) / sigma_m;
    differences.push_back({change.norm(), noise_share * sigma_m});
  }
  judge(differences, chance.judged_share, result);
  result.lost = planned.scan.ray.size() + fuller.scan.ray.size() - 2 * result.rays;
  if (result.rays > 0) result.bias_sigma = bias / static_cast<double>(result.rays);
  result.pass = result.pass && std::abs(result.bias_sigma) <= most_bias_sigma;
  return result;
}

bool is_random(Effect effect) {
  return effect == Effect::shot_noise || effect == Effect::read_noise;
}

}  // namespace

std::vector<EffectComparison> check_plan(const Recipe& recipe) {
  const synth::Scanner scanner = synth::thinned(recipe.scanner, checked_rays);
  const std::vector<Pose> views = synth::true_poses(recipe.viewpoints);
  const synth::EffectPlan plan =
      synth::plan_effects(recipe.scanner, recipe.scene.scene, views, recipe.effects);
  const Pose& view = views.front();
  const EffectSet chosen = synth::effects_of(plan);
  const Result planned = simulate_scan(recipe, scanner, view, chosen);
  const Chance chance = chance_of(scanner, recipe.scene.scene, view);
  std::vector<EffectComparison> comparisons;
  double bounds_m = 0;
  for (const synth::EffectDecision& decision : plan) {
    if (decision.on || is_random(decision.effect) || !(decision.bound_m > 0)) continue;
    bounds_m += decision.bound_m;
    const Result fuller =
        simulate_scan(recipe, scanner, view, EffectSet(chosen).set(decision.effect));
    comparisons.push_back(compare(std::string(synth::name(decision.effect)), decision.bound_m,
                                  planned, fuller, chance));
  }
  comparisons.push_back(compare("all", bounds_m, planned,
                                simulate_scan(recipe, scanner, view, EffectSet::all()), chance));
  return comparisons;
}

bool all_pass(const std::vector<EffectComparison>& comparisons) {
  return std::all_of(comparisons.begin(), comparisons.end(),
                     [](const EffectComparison& c) { return c.pass; });
}

void say(const std::vector<EffectComparison>& comparisons, const Console& console) {
  for (const EffectComparison& c : comparisons) {
    char text[200];
    std::snprintf(text, sizeof text, "  with %-18s %10s of at most %10s, bias %+.3f sigma, %s",
                  c.effect.c_str(), readable_length(c.difference_m).c_str(),
                  readable_length(c.bound_m).c_str(), c.bias_sigma, c.pass ? "pass" : "FAIL");
    console.say(text);
  }
}

nlohmann::ordered_json to_json(const std::vector<EffectComparison>& comparisons) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const EffectComparison& c : comparisons)
    list.push_back({{"effect", c.effect},
                    {"rays", c.rays},
                    {"lost", c.lost},
                    {"bound_m", c.bound_m},
                    {"difference_m", c.difference_m},
                    {"sampling_m", c.sampling_m},
                    {"bias_sigma", c.bias_sigma},
                    {"pass", c.pass}});
  return list;
}

}  // namespace scan
