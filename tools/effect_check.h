// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The effect plan put to the test: what is left out is switched on, and the points are compared.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/console.h"
#include "tools/recipe.h"

namespace scan {

// Ranges with more effects against ranges by the plan, both without random noise, ray by ray.
struct EffectComparison {
  std::string effect;       // switched on besides the plan's; "all" for every effect
  std::size_t rays = 0;     // that gave a point both times
  std::size_t lost = 0;     // that gave a point only once
  double bound_m = 0;       // the plan's; for "all" the sum over what the plan left out
  double difference_m = 0;  // where bound and chance explain it least
  double sampling_m = 0;    // of difference_m that chance explains: finitely many paths, rounding
  double bias_sigma = 0;    // mean difference over the points' own sigma
  // Every difference (of a stereo pair, 99 of 100) within bound_m plus sampling_m, and |bias| at
  // most 0.1.
  bool pass = true;
};

// The plan that the recipe leads to, on some ten thousand rays of the first viewpoint.
std::vector<EffectComparison> check_plan(const Recipe& recipe);

bool all_pass(const std::vector<EffectComparison>& comparisons);
void say(const std::vector<EffectComparison>& comparisons, const Console& console);
nlohmann::ordered_json to_json(const std::vector<EffectComparison>& comparisons);

}  // namespace scan
