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

constexpr std::array<std::string_view, 3> effect_names = {"shot noise", "read noise",
                                                          "quantisation"};
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

// "shot-noise" and "shot_noise" name "shot noise".
std::string known_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '-' || c == '_'; }, ' ');
  if (std::count(effect_names.begin(), effect_names.end(), name) > 0) return name;
  const auto nearest = *std::min_element(effect_names.begin(), effect_names.end(),
                                         [&](std::string_view a, std::string_view b) {
                                           return edit_distance(name, a) < edit_distance(name, b);
                                         });
  throw Error(
      Trouble::usage,
      "effects: '" + name + "' is unknown, not one of: shot noise, read noise, quantisation",
      "did you mean '" + std::string(nearest) + "'?");
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

bool is_on(const EffectChoice& choice, const std::vector<std::string>& named,
           std::string_view effect, const Weight& weight) {
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
  return std::count(named.begin(), named.end(), effect) > 0;
}

}  // namespace

EffectPlan plan_effects(const Scanner& scanner, const EffectChoice& choice) {
  check(scanner);
  std::vector<std::string> named;
  if (choice.kind == EffectChoice::Kind::named)
    for (const std::string& name : choice.names) named.push_back(known_name(name));
  const std::vector<Sensitivity> points = sensitivities(scanner);
  EffectPlan plan;
  for (std::size_t i = 0; i < effect_names.size(); ++i) {
    const Weight weight = weigh(points, i);
    const bool on = is_on(choice, named, effect_names[i], weight);
    plan.push_back({std::string(effect_names[i]), on, why(choice, weight, on), weight.bound_m});
  }
  return plan;
}

DetectorEffects detector_effects(const EffectPlan& plan) {
  const auto on = [&](std::string_view name) {
    return std::any_of(plan.begin(), plan.end(),
                       [&](const EffectDecision& d) { return d.effect == name && d.on; });
  };
  return {.shot_noise = on(effect_names[0]),
          .read_noise = on(effect_names[1]),
          .quantisation = on(effect_names[2])};
}

}  // namespace scan::synth
