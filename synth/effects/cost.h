// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What each effect costs, measured.
#pragma once

#include "synth/effects/plan.h"

namespace scan::synth {

// Fills cost_s: seconds of all `scans` with the effect minus seconds without it, for effects that
// the plan gives a weight; from renderings of about one ray in 200 from `view`, so it is an
// estimate, and never negative.
void measure_costs(EffectPlan& plan, const Scanner& scanner, const Scene& scene, const Pose& view,
                   int scans);

}  // namespace scan::synth
