// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "libscan/core/error.h"
#include "synth/effects/sensitivity.h"

namespace scan::synth {
namespace {

constexpr std::array<Effect, 3> weighed = {Effect::shot_noise, Effect::read_noise,
                                           Effect::quantisation};
constexpr double negligible = 0.01;  // of the scanner's own sigma

// Levenshtein's distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, changed});
    }
  }
  return row.back();
}

Effect known_effect(const std::string& word) {
  if (const auto effect = effect_named(word)) return *effect;
  const auto effects = all_effects();
  const auto nearest = *std::min_element(effects.begin(), effects.end(), [&](Effect a, Effect b) {
    return edit_distance(word, name(a)) < edit_distance(word, name(b));
  });
  std::string known;
  for (const Effect effect : effects)
    known += (known.empty() ? "" : ", ") + std::string(name(effect));
  throw Error(Trouble::usage, "effects: '" + word + "' is unknown, not one of: " + known,
              "did you mean '" + std::string(name(nearest)) + "'?");
}

// Range error of one effect if it is left out: three sigma of the noises, and what rounding by half
// a step in every reading can do at most.
std::array<double, 3> bounds_at(const Sensitivity& point) {
  return {3 * point.shot_m, 3 * point.sensor.read_noise_e * point.per_electron_m,
          point.sensor.gain_e_per_dn / 2 * point.worst_per_electron_m};
}

// The scanner's own sigma with all effects; rounding is uniform, of variance step^2 / 12.
double sigma_at(const Sensitivity& point) {
  const double step_e = point.sensor.gain_e_per_dn;
  const double white_e = std::hypot(point.sensor.read_noise_e, step_e / std::sqrt(12.0));
  return std::hypot(point.shot_m, white_e * point.per_electron_m);
}

struct Weight {
  double bound_m = 0;  // largest over the working points
  double share = 0;    // of the scanner's own sigma, largest over the working points
};

Weight weigh(const std::vector<Sensitivity>& points, std::size_t effect) {
  Weight weight;
  for (const Sensitivity& point : points) {
    const double bound_m = bounds_at(point)[effect];
    weight.bound_m = std::max(weight.bound_m, bound_m);
    weight.share = std::max(weight.share, bound_m / sigma_at(point));
  }
  return weight;
}

std::string why(const EffectChoice& choice, const Weight& weight, bool on) {
  char size[160];
  std::snprintf(size, sizeof size,
                "it moves a range by at most %.3g mm, %.3g %% of the scanner's own sigma",
                weight.bound_m * 1e3, weight.share * 100);
  const std::string bound = size;
  switch (choice.kind) {
    case EffectChoice::Kind::automatic:
      return on ? "On, since " + bound + "." : "Off, since " + bound + ", below 1 %.";
    case EffectChoice::Kind::all:
      return "On, as all effects were asked for; " + bound + ".";
    case EffectChoice::Kind::none:
      return "Off, as no effects were asked for; " + bound + ".";
    case EffectChoice::Kind::named:
      break;
  }
  return (on ? "On, as named; " : "Off, as not named; ") + bound + ".";
}

bool is_on(const EffectChoice& choice, const EffectSet& named, Effect effect,
           const Weight& weight) {
  switch (choice.kind) {
    case EffectChoice::Kind::automatic:
      return weight.share >= negligible;
    case EffectChoice::Kind::all:
      return true;
    case EffectChoice::Kind::none:
      return false;
    case EffectChoice::Kind::named:
      break;
  }
  return named.has(effect);
}

}  // namespace

void check(const EffectChoice& choice) {
  if (choice.kind == EffectChoice::Kind::named)
    for (const std::string& word : choice.names) known_effect(word);
}

EffectPlan plan_effects(const Scanner& scanner, const Scene& scene, std::span<const Pose>,
                        const EffectChoice& choice) {
  check(scanner);
  check(scene);
  EffectSet named;
  if (choice.kind == EffectChoice::Kind::named)
    for (const std::string& word : choice.names) named.set(known_effect(word));
  const std::vector<Sensitivity> points = sensitivities(scanner);
  EffectPlan plan;
  for (std::size_t i = 0; i < weighed.size(); ++i) {
    const Weight weight = weigh(points, i);
    const bool on = is_on(choice, named, weighed[i], weight);
    plan.push_back({weighed[i], on, why(choice, weight, on), weight.bound_m, weight.share, 0});
  }
  plan.push_back({Effect::footprint, true, "On, as the recipe's sub-rays say.", 0, 0, 0});
  return plan;
}

EffectSet effects_of(const EffectPlan& plan) {
  EffectSet effects;
  for (const EffectDecision& decision : plan) effects.set(decision.effect, decision.on);
  return effects;
}

}  // namespace scan::synth
