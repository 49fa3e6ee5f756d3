// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A Gaussian pulse integrated over each sample's interval, tabulated.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace scan::synth {

// Samples [first, behind).
struct SampleRange {
  std::size_t first = 0, behind = 0;
};

// For pulses of one width. The place of the pulse's middle between two samples is cut into cells of
// at most sigma / 16; in each cell every sample has the Taylor series of its integral to the fifth
// order. With at most sigma / 32 from the cell's middle what is left out is below
// 2 * (1/32)^6 / 720 * max|Phi^(6)| = 6e-12 of the pulse.
class PulseTable {
 public:
  // `sigma` in samples. Too wide or too narrow pulses get no table.
  explicit PulseTable(double sigma);

  bool exists() const { return !series_.empty(); }
  // Of a pulse whose middle is at `middle`; sample i is the interval about i.
  struct Place {
    std::ptrdiff_t start = 0;  // the first sample that it touches, may lie before the window
    const double* series = nullptr;
    double x = 0;
  };
  Place place(double middle) const;
  // The samples that it touches of a window of so many: all within 7.5 sigma; 6e-14 of the pulse
  // lies beyond.
  SampleRange touched(const Place& place, std::size_t samples) const;
  // Adds a pulse with that integral to those samples, which the pulse touches; `samples` points to
  // the first of them.
  void add(const Place& place, double total, const SampleRange& range, double* samples) const;

  static constexpr double reach_sigmas = 7.5;
  static constexpr std::size_t terms = 6;

 private:
  std::size_t cells_ = 0;
  std::size_t width_ = 0;       // samples that a pulse touches
  std::ptrdiff_t before_ = 0;   // of them before the one that holds the middle
  std::vector<double> series_;  // [cell][term][sample]
};

// samples[i] += total * sum_n series[n * stride + i] x^n; the versions that this processor can run.
using PulseKernel = void(const double* series, std::size_t stride, double x, double total,
                         double* samples, std::size_t count);
std::span<PulseKernel* const> pulse_kernels();

}  // namespace scan::synth
