// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The range walk: light that the detector takes for one pulse, and how late it shows it.
#pragma once

#include <span>
#include <vector>

#include "synth/scanners/pulsed_lidar_echo.h"

namespace scan::synth {

// What arrives until `end_s`, and after the pulse before, is shown `late_s` later than it came.
struct DelayedPulse {
  double end_s = 0;
  double late_s = 0;
};

// Arrivals of any order, direct or over other ways; each that follows another within 4 pulse sigmas
// belongs to the same pulse. Pulses end midway to the next one. Sorts the arrivals by time.
std::vector<DelayedPulse> delayed_pulses(const RangeWalk& walk, double pulse_sigma_s,
                                         std::vector<Echo>& arrivals);

// Of light that arrives then; 0 without pulses.
double delay_s(std::span<const DelayedPulse> pulses, double time_s);

}  // namespace scan::synth
