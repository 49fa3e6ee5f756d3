// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The effect plan put to the test: what is left out is switched on, and the points are compared.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "tools/console.h"
#include "tools/paired_scans.h"
#include "tools/recipe.h"

namespace scan {

// The plan that the recipe leads to, on some thousand rays of the first viewpoint: each effect that
// it leaves out switched on alone, then all of them. Noise of the detector is left out of both
// scans of a pair; where a point is beyond its bound, and for stereo pairs, read noise comes in,
// the same in both, so that steps of the decoder do not count. Where there is chance pairs are
// repeated, and again while the answer is open for more than one point in twenty and the work
// allows.
std::vector<EffectComparison> check_plan(const Recipe& recipe);

bool all_pass(const std::vector<EffectComparison>& comparisons);
void say(const std::vector<EffectComparison>& comparisons, const Console& console);
nlohmann::ordered_json to_json(const std::vector<EffectComparison>& comparisons);

}  // namespace scan
