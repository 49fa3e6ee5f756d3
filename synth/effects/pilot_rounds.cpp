// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/pilot_rounds.h"

#include "libscan/core/parallel.h"

namespace scan::synth {
namespace {

constexpr std::size_t rounds = 16;
constexpr std::size_t rays_at_once = 8;  // of one thread: paths take their time

// Whether some ray includes each of the effects.
bool are_included(const EffectSet& effects, const std::vector<std::optional<PilotRay>>& seen) {
  for (const Effect effect : all_effects()) {
    if (!effects.has(effect)) continue;
    bool included = false;
    for (const auto& ray : seen)
      included |= ray && ray->left_out_m[static_cast<std::size_t>(effect)] >=
                             negligible_sigma * ray->sigma_m;
    if (!included) return false;
  }
  return true;
}

}  // namespace

std::vector<PilotRay> look_in_rounds(
    std::size_t count, const EffectSet& by_paths,
    const std::function<std::optional<PilotRay>(std::size_t, bool)>& look) {
  std::vector<std::optional<PilotRay>> seen(count);
  bool with_paths = true;
  for (std::size_t round = 0; round < std::min(rounds, count); ++round) {
    const std::size_t some = (count - round + rounds - 1) / rounds;
    parallel_for(
        some,
        [&](std::size_t k) {
          const std::size_t i = k * rounds + round;
          seen[i] = look(i, with_paths);
        },
        rays_at_once);
    with_paths = with_paths && !are_included(by_paths, seen);
  }
  std::vector<PilotRay> found;
  for (const auto& ray : seen)
    if (ray) found.push_back(*ray);
  return found;
}

}  // namespace scan::synth
