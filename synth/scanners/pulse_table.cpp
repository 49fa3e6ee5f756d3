// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulse_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "libscan/core/instruction_sets.h"

namespace scan::synth {
namespace {

constexpr double cells_per_sigma = 16;
constexpr double most_entries = 32768;  // 256 KiB
constexpr std::size_t terms = PulseTable::terms;
constexpr double farthest = 1e15;  // samples from the window's start; no window reaches so far

using Series = std::array<double, terms>;

// Of the pulse's share before an edge at z sigmas from the middle, when the middle moves by x
// samples: the n-th derivative is -He_{n-1}(z) phi(z) / sigma^n, He_n the Hermite polynomials.
Series before_edge(double z, double sigma) {
  const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
  Series series = {0.5 * std::erfc(-z / std::numbers::sqrt2)};
  double hermite = 1, lower = 0, scale = -density;
  for (std::size_t n = 1; n < terms; ++n) {
    scale /= sigma * static_cast<double>(n);
    series[n] = scale * hermite;
    const double next = z * hermite - static_cast<double>(n - 1) * lower;
    lower = std::exchange(hermite, next);
  }
  return series;
}

SCAN_INLINE void add_series(const double* __restrict series, std::size_t stride, double x,
                            double total, double* __restrict samples, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    double share = series[5 * stride + i];
    share = share * x + series[4 * stride + i];
    share = share * x + series[3 * stride + i];
    share = share * x + series[2 * stride + i];
    share = share * x + series[stride + i];
    share = share * x + series[i];
    samples[i] += total * share;
  }
}

void add_plain(const double* series, std::size_t stride, double x, double total, double* samples,
               std::size_t count) {
  add_series(series, stride, x, total, samples, count);
}
SCAN_AVX2 void add_avx2(const double* series, std::size_t stride, double x, double total,
                        double* samples, std::size_t count) {
  add_series(series, stride, x, total, samples, count);
}
SCAN_AVX512 void add_avx512(const double* series, std::size_t stride, double x, double total,
                            double* samples, std::size_t count) {
  add_series(series, stride, x, total, samples, count);
}

const Versions<PulseKernel> versions(add_plain, add_avx2, add_avx512);

}  // namespace

PulseTable::PulseTable(double sigma) {
  const double reach = std::ceil(reach_sigmas * sigma + 0.5);
  const double cells = std::ceil(cells_per_sigma / sigma);
  if (!((2 * reach + 1) * cells * terms <= most_entries)) return;
  before_ = static_cast<std::ptrdiff_t>(reach);
  width_ = static_cast<std::size_t>(2 * reach + 1);
  cells_ = static_cast<std::size_t>(cells);
  series_.resize(cells_ * terms * width_);
  for (std::size_t cell = 0; cell < cells_; ++cell) {
    const double middle = reach + (static_cast<double>(cell) + 0.5) / cells;
    Series before = before_edge((-0.5 - middle) / sigma, sigma);
    for (std::size_t i = 0; i < width_; ++i) {
      const Series after = before_edge((static_cast<double>(i) + 0.5 - middle) / sigma, sigma);
      for (std::size_t n = 0; n < terms; ++n)
        series_[(cell * terms + n) * width_ + i] = after[n] - before[n];
      before = after;
    }
  }
}

PulseTable::Place PulseTable::place(double middle) const {
  middle = std::clamp(middle, -farthest, farthest);
  auto whole = static_cast<std::ptrdiff_t>(middle);
  if (static_cast<double>(whole) > middle) --whole;
  const double place = middle - static_cast<double>(whole);
  const auto cells = static_cast<std::ptrdiff_t>(cells_);
  const auto cell =
      std::min(cells - 1, static_cast<std::ptrdiff_t>(place * static_cast<double>(cells)));
  return {.start = whole - before_,
          .series = &series_[static_cast<std::size_t>(cell) * terms * width_],
          .x = place - (static_cast<double>(cell) + 0.5) / static_cast<double>(cells)};
}

SampleRange PulseTable::touched(const Place& place, std::size_t samples) const {
  const auto end = static_cast<std::ptrdiff_t>(samples);
  const std::ptrdiff_t first = std::clamp<std::ptrdiff_t>(place.start, 0, end);
  const auto behind = std::clamp(place.start + static_cast<std::ptrdiff_t>(width_), first, end);
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(behind)};
}

void PulseTable::add(const Place& place, double total, const SampleRange& range,
                     double* samples) const {
  const auto skipped = static_cast<std::ptrdiff_t>(range.first) - place.start;
  versions.fastest()(place.series + skipped, width_, place.x, total, samples,
                     range.behind - range.first);
}

std::span<PulseKernel* const> pulse_kernels() {
  return versions.all();
}

}  // namespace scan::synth
