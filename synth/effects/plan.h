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
  std::string effect;  // "shot noise", "read noise", "quantisation"
  bool on = true;
  std::string reason;  // one sentence
  double bound_m = 0;  // of the ranging error if it is left out
};

using EffectPlan = std::vector<EffectDecision>;

// How effects are chosen: by the planner, all, none, or exactly those named.
struct EffectChoice {
  enum class Kind { automatic, all, none, named } kind = Kind::automatic;
  std::vector<std::string> names;
};

// The planner weighs each effect at the scanner's strongest and weakest working point (see
// sensitivity.h) and leaves out what moves a range by less than 1 % of the scanner's own sigma at
// both. Throws scan::Error: usage for an unknown effect, with the nearest known name as a hint;
// input for a scanner that is not valid.
EffectPlan plan_effects(const Scanner& scanner, const EffectChoice& choice);
DetectorEffects detector_effects(const EffectPlan& plan);

}  // namespace scan::synth
