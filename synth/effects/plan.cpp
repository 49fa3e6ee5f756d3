// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/plan.h"

#include <algorithm>
#include <cstdio>

#include "libscan/core/error.h"
#include "libscan/core/nearest_word.h"
#include "synth/effects/thin.h"
#include "synth/effects/weight.h"

namespace scan::synth {
namespace {

constexpr std::size_t most_views = 8;  // that the pilot looks from
// Rays that it looks along, over all of them: a share of the scans' rays, so that quick scans are
// planned quickly, within limits.
constexpr double pilot_share = 0.02;
constexpr double least_pilot_rays = 1024, most_pilot_rays = 4096;

Effect known_effect(const std::string& word) {
  if (const auto effect = effect_named(word)) return *effect;
  // As they are typed on the command line, where a space would part them.
  std::vector<std::string> words;
  std::string known;
  for (const Effect effect : all_effects()) {
    words.emplace_back(name(effect));
    std::ranges::replace(words.back(), ' ', '-');
    known += (known.empty() ? "" : ", ") + words.back();
  }
  const std::string near = nearest_word(word, words);
  throw Error(Trouble::usage, "effects: '" + word + "' is none of " + known,
              near.empty() ? "" : "did you mean '" + near + "'?");
}

// Evenly spread over the viewpoints.
std::vector<PilotRay> pilot_all(const Scanner& scanner, const Scene& scene,
                                std::span<const Pose> views) {
  std::vector<PilotRay> rays;
  if (views.empty()) return rays;
  const RayCaster caster(scene);
  const std::size_t count = std::min(most_views, views.size());
  const double all_rays = ray_count(scanner) * static_cast<double>(views.size());
  const int rays_of_view =
      static_cast<int>(std::clamp(pilot_share * all_rays, least_pilot_rays, most_pilot_rays) /
                       static_cast<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const Pose& view = views[i * views.size() / count];
    auto seen =
        std::visit([&](const auto& s) { return pilot(s, caster, view, rays_of_view); }, scanner);
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
      return weighed.weight && weighed.weight->bound_sigma >= negligible_sigma;
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
