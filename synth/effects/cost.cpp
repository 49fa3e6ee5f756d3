// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/cost.h"

#include <algorithm>

#include "libscan/core/cost.h"
#include "synth/effects/thin.h"

namespace scan::synth {
namespace {

constexpr double one_ray_in = 200;

double render_s(const Scanner& scanner, const Scene& scene, const Pose& view,
                const EffectSet& effects) {
  const RayCaster caster(simplified(scene, effects));
  const Stopwatch watch;
  render(scanner, caster, view, {}, effects);
  return watch.seconds();
}

}  // namespace

void measure_costs(EffectPlan& plan, const Scanner& scanner, const Scene& scene, const Pose& view,
                   int scans) {
  const Scanner few = thinned(scanner, ray_count(scanner) / one_ray_in);
  const double scale = scans * ray_count(scanner) / ray_count(few);
  const EffectSet chosen = effects_of(plan);
  const double chosen_s = render_s(few, scene, view, chosen);
  for (EffectDecision& decision : plan) {
    if (!(decision.bound_m > 0)) continue;
    EffectSet other = chosen;
    const double other_s = render_s(few, scene, view, other.set(decision.effect, !decision.on));
    decision.cost_s = scale * std::max(0.0, decision.on ? chosen_s - other_s : other_s - chosen_s);
  }
}

}  // namespace scan::synth
