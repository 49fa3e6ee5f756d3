// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/cost.h"

#include <algorithm>

#include "libscan/core/cost.h"
#include "synth/effects/thin.h"

namespace scan::synth {
namespace {

constexpr double one_ray_in = 200;

double render_s(const Scanner& scanner, const RayCaster& caster, const Pose& view,
                const EffectSet& effects) {
  const Stopwatch watch;
  render(scanner, caster, view, {}, effects);
  return watch.seconds();
}

// Whether a scene is the same with the effect and without it (see simplified()).
bool keeps_scene(Effect effect) {
  return effect != Effect::medium && effect != Effect::scene_lights &&
         effect != Effect::refraction && effect != Effect::subsurface;
}

}  // namespace

void measure_costs(EffectPlan& plan, const Scanner& scanner, const Scene& scene, const Pose& view,
                   int scans) {
  const Scanner few = thinned(scanner, ray_count(scanner) / one_ray_in);
  const double scale = scans * ray_count(scanner) / ray_count(few);
  const EffectSet chosen = effects_of(plan);
  const RayCaster caster(simplified(scene, chosen));
  const double chosen_s = render_s(few, caster, view, chosen);
  for (EffectDecision& decision : plan) {
    if (!(decision.bound_m > 0)) continue;
    EffectSet other = chosen;
    other.set(decision.effect, !decision.on);
    const double other_s = keeps_scene(decision.effect)
                               ? render_s(few, caster, view, other)
                               : render_s(few, RayCaster(simplified(scene, other)), view, other);
    decision.cost_s = scale * std::max(0.0, decision.on ? chosen_s - other_s : other_s - chosen_s);
  }
}

}  // namespace scan::synth
