// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Mean signals by as many samples as the device's own noise makes worth while.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace scan::synth {

struct SamplingGoal {
  double share_of_noise = 0.2;  // standard error of a mean over the reading's noise, at most
  int least_samples = 16;       // a multiple of the four independent streams
  int most_samples = 4096;      // of which a multiple of four is drawn
};

// Throws scan::Error (input) naming field, value and limit.
void check(const SamplingGoal& goal);

// The error of a mean over its standard error follows Student's t with 3 degrees of freedom if the
// four streams' means are normal.
struct Estimate {
  std::vector<double> mean;
  std::vector<double> standard_error;  // from the spread of four independent streams
  int samples = 0;                     // drawn
};

// Adds up `draw(stream, index, signals)`, which adds sample `index` of one of four independent
// streams to the signals (streams' sequences start at index 0), doubling the number until every
// signal's standard error is at most share_of_noise times `noise(mean)`, or most_samples are drawn.
// The mean of each stream is taken at the number that the other three ask for by their spread: so
// it is unbiased, where stopping by its own samples would favour those that miss rare bright ones
// (one in ten bright: low by a fifth). What other streams draw beyond that serves their decision
// only. Rare bright samples can still make single means noisy: least_samples should meet some.
Estimate estimate(std::size_t signals, const SamplingGoal& goal,
                  const std::function<double(double)>& noise,
                  const std::function<void(int, int, std::span<double>)>& draw);

// The same with memory that is used again from pixel to pixel; `result` is overwritten.
struct EstimateMemory {
  std::vector<double> sums;   // of each stream
  std::vector<double> means;  // of each stream, where the others let it stop
};
void estimate(std::size_t signals, const SamplingGoal& goal,
              const std::function<double(double)>& noise,
              const std::function<void(int, int, std::span<double>)>& draw, EstimateMemory& memory,
              Estimate& result);

}  // namespace scan::synth
