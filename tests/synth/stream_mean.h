// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Means of random estimates with their standard errors, from independent streams.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "libscan/core/parallel.h"
#include "synth/sampling/sequence.h"

namespace scan::synth {

struct StreamMean {
  double mean = 0;
  double error = 0;  // standard error of the mean
};

inline StreamMean mean_of(const std::vector<double>& streams) {
  const auto n = static_cast<double>(streams.size());
  double sum = 0, squares = 0;
  for (const double value : streams) sum += value;
  for (const double value : streams) squares += std::pow(value - sum / n, 2);
  return {sum / n, std::sqrt(squares / (n * (n - 1)))};
}

// Of estimate(sequence), over `streams` independent streams of `samples` low-discrepancy points.
// The spread of the streams' means tells the error; a difference of 4.5 errors has a chance of 1e-4
// (Student, 31 degrees of freedom).
template <class Estimate>
StreamMean stream_mean(int samples, Estimate&& estimate, int streams = 32) {
  std::vector<double> means(streams, 0.0);
  parallel_for(
      means.size(),
      [&](std::size_t i) {
        SampleSequence sequence(11, 5, 3, static_cast<std::uint32_t>(i));
        for (int sample = 0; sample < samples; ++sample) {
          sequence.start(sample);
          means[i] += estimate(sequence) / samples;
        }
      },
      1);
  return mean_of(means);
}

}  // namespace scan::synth
