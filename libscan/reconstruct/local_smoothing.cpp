// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/local_smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "libscan/core/median.h"

namespace scan {
namespace {

// A region must hold the scatter on both sides of its surface, 3 sigma each way: samples of one
// side alone gain from any fit that leans to them. And enough samples that strays, which lie
// together, do not ask for a length of their own: 12 make the edges of a sharp part 7 % better, and
// leave 25 handles along the bracket's, where 50 leave 4.
constexpr double samples_per_region = 50, sigmas_per_region = 6;
// Two fits differ by the same waves over some lengths: sums must reach over several such, or chance
// decides. Each pass of around() spreads by a variance of half a region's width squared.
constexpr double reach_in_lengths = 2;
constexpr int most_passes = 64;
// A sigma far below the others' would leave nothing to these.
constexpr double least_share_of_sigma = 0.1;
constexpr double exact = 1e-100;  // has an inverse, and sums of those

std::uint64_t key_of(const Eigen::Vector3i& cell) {
  return static_cast<std::uint64_t>(cell[2]) << 42 | static_cast<std::uint64_t>(cell[1]) << 21 |
         static_cast<std::uint64_t>(cell[0]);
}

}  // namespace

// integral over k of 1 / (1 + (length k)^3) k dk / (2 pi) = 1 / (3 sqrt(3) length^2)
double leverage(double area, double length) {
  const double share = area / (3 * std::sqrt(3.0) * length * length);
  return share / (1 + share);  // below 1, where the samples no longer form a continuum
}

// integral of x / (1 + x^3) dx / (2 pi length^2) to x = pi lengths_per_cell, half a wave a cell:
// the antiderivative is log((x^2 - x + 1) / (x + 1)^2) / 6 + atan((2 x - 1) / sqrt(3)) / sqrt(3).
double posterior_variance(double area, double length) {
  constexpr double pi = std::numbers::pi, x = pi * lengths_per_cell;
  const double root = std::sqrt(3.0);
  const double waves = std::log((x * x - x + 1) / ((x + 1) * (x + 1))) / 6 +
                       (std::atan((2 * x - 1) / root) + pi / 6) / root;
  const double share = waves / (2 * pi) * area / (length * length);
  return share / (1 + share);
}

LocalSmoothing::LocalSmoothing(const Samples& samples) : samples_(samples) {
  const double cell = std::max(std::sqrt(samples_per_region * median(samples.area)),
                               sigmas_per_region * median(samples.sigma));
  std::vector<std::uint64_t> keys, of_sample;
  const auto place_of = [&](const Eigen::Vector3d& u) {
    return Eigen::Vector3i((u / cell).array().floor().cast<int>() + 1);
  };
  for (const auto& u : samples.points) of_sample.push_back(key_of(place_of(u)));
  keys = of_sample;
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  const auto find = [&](std::uint64_t key) {
    const auto at = std::lower_bound(keys.begin(), keys.end(), key);
    return at != keys.end() && *at == key ? static_cast<std::int32_t>(at - keys.begin()) : -1;
  };
  for (const std::uint64_t key : of_sample)
    region_of_.push_back(static_cast<std::uint32_t>(find(key)));
  neighbours_.resize(keys.size());
  for (std::size_t r = 0; r < keys.size(); ++r)
    for (int i = 0; i < 27; ++i) {
      const std::int64_t step =
          (i % 3 - 1) + (std::int64_t{i / 3 % 3 - 1} << 21) + (std::int64_t{i / 9 - 1} << 42);
      neighbours_[r][i] = find(keys[r] + static_cast<std::uint64_t>(step));
    }
  region_width_ = cell;
  risk_.assign(keys.size(), std::numeric_limits<double>::infinity());
  length_.assign(keys.size(), 1.0);
  weigh();
}

void LocalSmoothing::weigh() {
  const double least = std::max(exact, least_share_of_sigma * median(samples_.sigma));
  for (const double sigma : samples_.sigma) weight_.push_back(1 / std::max(least, sigma));
  const std::vector<double> usual = mean_around(weight_);
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    const double share = std::min(1.0, weight_[i] / usual[i]);
    weight_[i] = share * share;
  }
}

// Sums of each region and, at half weight an axis, of those around it.
std::vector<double> LocalSmoothing::around(const std::vector<double>& sums) const {
  std::vector<double> result(sums.size(), 0.0);
  for (std::size_t r = 0; r < sums.size(); ++r)
    for (int i = 0; i < 27; ++i)
      if (neighbours_[r][i] >= 0) {
        const int off_centre = (i % 3 != 1) + (i / 3 % 3 != 1) + (i / 9 != 1);
        result[r] += std::ldexp(sums[neighbours_[r][i]], -off_centre);
      }
  return result;
}

std::vector<double> LocalSmoothing::mean_around(const std::vector<double>& values) const {
  std::vector<double> sums(length_.size(), 0.0), counts = sums, result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    sums[region_of_[i]] += std::abs(values[i]);
    counts[region_of_[i]] += 1;
  }
  sums = around(sums);
  counts = around(counts);
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = sums[region_of_[i]] / counts[region_of_[i]];
  return result;
}

std::vector<char> LocalSmoothing::are_positive_around(const std::vector<double>& values) const {
  std::vector<double> sums(length_.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) sums[region_of_[i]] += values[i];
  sums = around(sums);
  std::vector<char> result;
  for (const std::uint32_t r : region_of_) result.push_back(sums[r] > 0);
  return result;
}

std::vector<double> LocalSmoothing::lengths() const {
  const std::size_t regions = length_.size();
  std::vector<double> logs(regions), counts(regions, 0.0);
  for (const std::uint32_t r : region_of_) counts[r] += 1;
  for (std::size_t r = 0; r < regions; ++r) logs[r] = counts[r] * std::log(length_[r]);
  logs = around(logs);
  counts = around(counts);
  std::vector<double> result(region_of_.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = std::exp(logs[region_of_[i]] / counts[region_of_[i]]);
  return result;
}

double LocalSmoothing::judge(double trial, const std::vector<double>& residuals,
                             const std::vector<double>& trust) {
  std::vector<double> risk(length_.size(), 0.0), counts = risk, gain = risk;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double sigma2 = samples_.sigma[i] * samples_.sigma[i];
    risk[region_of_[i]] +=
        weight_[i] * trust[i] *
        (residuals[i] * residuals[i] + 2 * sigma2 * leverage(samples_.area[i], trial));
    counts[region_of_[i]] += 1;
  }
  for (std::size_t r = 0; r < risk.size(); ++r) gain[r] = risk_[r] - risk[r];
  const double widths = reach_in_lengths * trial / region_width_;
  const int passes = std::clamp(static_cast<int>(std::ceil(2 * widths * widths)), 1, most_passes);
  for (int pass = 0; pass < passes; ++pass) gain = around(gain);
  double lowered = 0, all = 0;
  for (std::size_t r = 0; r < risk.size(); ++r) {
    all += counts[r];
    if (!(gain[r] > 0)) continue;
    risk_[r] = risk[r];
    length_[r] = trial;
    lowered += counts[r];
  }
  return lowered / all;
}

}  // namespace scan
