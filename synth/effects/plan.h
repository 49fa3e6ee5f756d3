// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which effects a simulation includes, and why.
#pragma once

#include <string>
#include <vector>

#include "synth/detector.h"
#include "synth/scanner.h"

namespace scan::synth {

struct EffectDecision {
  std::string effect;    // "shot noise", "read noise", "quantisation"
  bool on = true;
  std::string reason;    // one sentence
  double bound_m = 0;    // of the ranging error if it is left out
};

using EffectPlan = std::vector<EffectDecision>;

// How effects are chosen: by the planner, all, none, or exactly those named.
struct EffectChoice {
  enum class Kind { automatic, all, none, named } kind = Kind::automatic;
  std::vector<std::string> names;
};

// Names an unknown effect in scan::Error (usage).
EffectPlan plan_effects(const Scanner& scanner, const EffectChoice& choice);
DetectorEffects detector_effects(const EffectPlan& plan);

}  // namespace scan::synth
