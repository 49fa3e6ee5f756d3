// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/plan.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <utility>

#include "libscan/core/error.h"
#include "synth/effects/weight.h"

namespace scan::synth {
namespace {

// Of the scanner's own sigma. Five effects left out together stay below a tenth of it.
constexpr double negligible = 0.02;

constexpr std::size_t most_views = 8;  // that the pilot looks from
constexpr int pilot_rays = 4096;       // over all of them

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

// Evenly spread over the viewpoints.
std::vector<PilotRay> pilot_all(const Scanner& scanner, const Scene& scene,
                                std::span<const Pose> views) {
  std::vector<PilotRay> rays;
  if (views.empty()) return rays;
  const RayCaster caster(scene);
  const std::size_t count = std::min(most_views, views.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Pose& view = views[i * views.size() / count];
    auto seen = std::visit(
        [&](const auto& s) { return pilot(s, caster, view, pilot_rays / static_cast<int>(count)); },
        scanner);
    rays.insert(rays.end(), std::make_move_iterator(seen.begin()),
                std::make_move_iterator(seen.end()));
  }
  return rays;
}

// "0.012 mm, 3.4 % of the scanner's own sigma".
std::string size_of(const Weight& weight) {
  char text[96];
  std::snprintf(text, sizeof text, "%.3g mm, %.3g %% of the scanner's own sigma",
                weight.bound_m * 1e3, weight.bound_sigma * 100);
  return text;
}

std::string reason_of(EffectChoice::Kind kind, bool on, const Weighed& weighed) {
  const std::string begin = on ? "On" : "Off";
  const std::string weight = weighed.weight
                                 ? weighed.weight->why + " (bound " + size_of(*weighed.weight) + ")"
                                 : weighed.why_absent;
  switch (kind) {
    case EffectChoice::Kind::automatic:
      return begin + ", since " + weight + ".";
    case EffectChoice::Kind::all:
      return begin + ", as all effects were asked for; " + weight + ".";
    case EffectChoice::Kind::none:
      return begin + ", as no effects were asked for; " + weight + ".";
    case EffectChoice::Kind::named:
      break;
  }
  return begin + (on ? ", as named; " : ", as not named; ") + weight + ".";
}

bool is_on(const EffectChoice& choice, const EffectSet& named, Effect effect,
           const Weighed& weighed) {
  switch (choice.kind) {
    case EffectChoice::Kind::automatic:
      return weighed.weight && weighed.weight->bound_sigma >= negligible;
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

EffectPlan plan_effects(const Scanner& scanner, const Scene& scene,
                        std::span<const Pose> world_from_scanner, const EffectChoice& choice) {
  check(scanner);
  check(scene);
  EffectSet named;
  if (choice.kind == EffectChoice::Kind::named)
    for (const std::string& word : choice.names) named.set(known_effect(word));
  const std::vector<PilotRay> rays = pilot_all(scanner, scene, world_from_scanner);
  EffectPlan plan;
  for (const Effect effect : all_effects()) {
    const Weighed weighed =
        std::visit([&](const auto& s) { return weigh(s, scene, effect, rays); }, scanner);
    const bool on = is_on(choice, named, effect, weighed);
    const Weight weight = weighed.weight.value_or(Weight{});
    plan.push_back(
        {effect, on, reason_of(choice.kind, on, weighed), weight.bound_m, weight.bound_sigma, 0});
  }
  return plan;
}

EffectSet effects_of(const EffectPlan& plan) {
  EffectSet effects;
  for (const EffectDecision& decision : plan) effects.set(decision.effect, decision.on);
  const bool all = std::all_of(plan.begin(), plan.end(), [](const auto& d) { return d.on; });
  return all ? EffectSet::all() : effects;
}

}  // namespace scan::synth
