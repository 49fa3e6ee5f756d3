// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulsed_lidar_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan::synth {

std::vector<DelayedPulse> delayed_pulses(const RangeWalk& walk, double pulse_sigma_s,
                                         std::vector<Echo>& arrivals) {
  std::sort(arrivals.begin(), arrivals.end(),
            [](const Echo& a, const Echo& b) { return a.time_s < b.time_s; });
  const double gap_s = 4 * pulse_sigma_s;
  std::vector<DelayedPulse> pulses;
  for (std::size_t first = 0, behind = 0; first < arrivals.size(); first = behind) {
    double electrons = 0, last_s = arrivals[first].time_s;
    if (!pulses.empty()) pulses.back().end_s = (pulses.back().end_s + last_s) / 2;
    for (behind = first; behind < arrivals.size() && arrivals[behind].time_s - last_s <= gap_s;
         ++behind) {
      electrons += arrivals[behind].electrons;
      last_s = arrivals[behind].time_s;
    }
    const double decades = std::log10(std::max(electrons, 1.0) / walk.at_electrons);
    pulses.push_back({.end_s = last_s, .late_s = walk.per_decade_s * decades});
  }
  if (!pulses.empty()) pulses.back().end_s = std::numeric_limits<double>::infinity();
  return pulses;
}

double delay_s(std::span<const DelayedPulse> pulses, double time_s) {
  const auto pulse =
      std::lower_bound(pulses.begin(), pulses.end(), time_s,
                       [](const DelayedPulse& p, double time) { return p.end_s < time; });
  return pulse == pulses.end() ? 0 : pulse->late_s;
}

}  // namespace scan::synth
