// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Mean signals by as many samples as the device's own noise makes worth while.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace scan::synth {

struct SamplingGoal {
  double share_of_noise = 0.2;  // standard error of a mean over the reading's noise, at most
  int least_samples = 16;       // a multiple of the four independent streams
  int most_samples = 4096;
};

struct Estimate {
  std::vector<double> mean;
  std::vector<double> standard_error;  // from the spread of four independent streams
  int samples = 0;
};

// Adds up `draw(stream, index, signals)`, which adds sample `index` of one of four independent
// streams to the signals (streams' sequences start at index 0), doubling the number until every
// signal's standard error is at most share_of_noise times `noise(mean)`, or most_samples are drawn.
Estimate estimate(std::size_t signals, const SamplingGoal& goal,
                  const std::function<double(double)>& noise,
                  const std::function<void(int, int, std::span<double>)>& draw);

}  // namespace scan::synth
