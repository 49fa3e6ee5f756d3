// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which effects a simulation includes, and why.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "synth/effects/effect.h"
#include "synth/scanner.h"

namespace scan::synth {

struct EffectDecision {
  Effect effect = Effect::shot_noise;
  bool on = true;
  std::string reason;      // one sentence
  double bound_m = 0;      // of the ranging error if it is left out
  double bound_sigma = 0;  // the same over the scanner's own sigma there
  double cost_s = 0;       // measured or estimated, of one scan with it minus one without
};

using EffectPlan = std::vector<EffectDecision>;

// How effects are chosen: by the planner, all, none, or exactly those named.
struct EffectChoice {
  enum class Kind { automatic, all, none, named } kind = Kind::automatic;
  std::vector<std::string> names;
};

// Throws scan::Error (usage) for an unknown effect, with the nearest known name as a hint.
void check(const EffectChoice& choice);

// The planner weighs each effect for this scanner, scene and these viewpoints and leaves out what
// moves no range by more than a small share of the scanner's own sigma. Throws what check throws.
EffectPlan plan_effects(const Scanner& scanner, const Scene& scene,
                        std::span<const Pose> world_from_scanner, const EffectChoice& choice);
// Those that are on; if all are, everywhere.
EffectSet effects_of(const EffectPlan& plan);

}  // namespace scan::synth
