// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/shortest.h"

namespace scan::synth {
namespace {

constexpr int streams = 4;

// Mean of the streams' means, and its standard error by their scatter.
void summarise(std::span<const double> means, Estimate& result) {
  const std::size_t signals = result.mean.size();
  for (std::size_t s = 0; s < signals; ++s) {
    double total = 0, scatter = 0;
    for (int k = 0; k < streams; ++k) total += means[k * signals + s];
    const double mean = total / streams;
    for (int k = 0; k < streams; ++k) {
      const double error = means[k * signals + s] - mean;
      scatter += error * error;
    }
    result.mean[s] = mean;
    result.standard_error[s] = std::sqrt(scatter / (streams * (streams - 1)));
  }
}

// Whether the scatter of the streams but `left_out` lets the standard error of all four pass.
bool others_suffice(std::span<const double> sums, std::size_t signals, int per_stream, int left_out,
                    const SamplingGoal& goal, const std::function<double(double)>& noise) {
  constexpr int others = streams - 1;
  for (std::size_t s = 0; s < signals; ++s) {
    double total = 0, scatter = 0;
    for (int k = 0; k < streams; ++k)
      if (k != left_out) total += sums[k * signals + s];
    const double mean = total / (others * per_stream);
    for (int k = 0; k < streams; ++k) {
      if (k == left_out) continue;
      const double error = sums[k * signals + s] / per_stream - mean;
      scatter += error * error;
    }
    const double standard_error = std::sqrt(scatter / (others - 1) / streams);
    if (!(standard_error <= goal.share_of_noise * noise(mean))) return false;
  }
  return true;
}

}  // namespace

void check(const SamplingGoal& goal) {
  if (!(goal.share_of_noise >= 0))
    throw Error(Trouble::input,
                "share_of_noise is " + shortest(goal.share_of_noise) + ", must not be negative");
  if (goal.least_samples < streams || goal.least_samples % streams != 0)
    throw Error(Trouble::input, "least_samples is " + std::to_string(goal.least_samples) +
                                    ", must be a multiple of 4 above 0");
  if (goal.most_samples < goal.least_samples)
    throw Error(Trouble::input, "most_samples is " + std::to_string(goal.most_samples) +
                                    ", must be at least least_samples, " +
                                    std::to_string(goal.least_samples));
}

Estimate estimate(std::size_t signals, const SamplingGoal& goal,
                  const std::function<double(double)>& noise,
                  const std::function<void(int, int, std::span<double>)>& draw) {
  EstimateMemory memory;
  Estimate result;
  estimate(signals, goal, noise, draw, memory, result);
  return result;
}

void estimate(std::size_t signals, const SamplingGoal& goal,
              const std::function<double(double)>& noise,
              const std::function<void(int, int, std::span<double>)>& draw, EstimateMemory& memory,
              Estimate& result) {
  memory.sums.assign(streams * signals, 0);
  memory.means.assign(streams * signals, 0);
  result.mean.assign(signals, 0);
  result.standard_error.assign(signals, 0);
  result.samples = 0;
  if (signals == 0) return;
  const int most = goal.most_samples / streams;
  std::array<bool, streams> has_mean = {};
  int drawn = 0, wanted = goal.least_samples / streams;
  while (std::find(has_mean.begin(), has_mean.end(), false) != has_mean.end()) {
    for (int k = 0; k < streams; ++k)
      for (int i = drawn; i < wanted; ++i)
        draw(k, i, std::span(memory.sums).subspan(k * signals, signals));
    drawn = wanted;
    for (int k = 0; k < streams; ++k) {
      if (has_mean[k]) continue;
      has_mean[k] = drawn == most || others_suffice(memory.sums, signals, drawn, k, goal, noise);
      if (!has_mean[k]) continue;
      for (std::size_t s = 0; s < signals; ++s)
        memory.means[k * signals + s] = memory.sums[k * signals + s] / drawn;
    }
    wanted = std::min(2 * drawn, most);
  }
  summarise(memory.means, result);
  result.samples = streams * drawn;
}

}  // namespace scan::synth
