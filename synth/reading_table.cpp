// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/reading_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan::synth {
namespace {

constexpr double most_terms = 2e6;     // counts times outcomes
constexpr double reach_sigmas = 9;     // of the normal distribution: 1e-19 lies beyond
constexpr double least_share = 1e-20;  // of the most probable count

struct Counts {
  double first = 0;
  std::vector<double> probability;
};

// Poisson's distribution by its ratios from the mode outwards, p(k + 1) / p(k) = mean / (k + 1).
Counts poisson_counts(double mean) {
  const double mode = std::floor(mean);
  std::vector<double> below, above = {1};
  for (double k = mode; k > 0 && (below.empty() || below.back() > least_share); --k)
    below.push_back((below.empty() ? 1 : below.back()) * k / mean);
  for (double k = mode + 1; above.back() > least_share; ++k)
    above.push_back(above.back() * mean / k);
  Counts counts{mode - static_cast<double>(below.size()), {below.rbegin(), below.rend()}};
  counts.probability.insert(counts.probability.end(), above.begin(), above.end());
  double sum = 0;
  for (const double p : counts.probability) sum += p;
  for (double& p : counts.probability) p /= sum;
  return counts;
}

double below(double x) {  // the standard normal distribution
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

}  // namespace

ReadingTable::ReadingTable(const Sensor& sensor, const DetectorEffects& effects, double expected_e)
    : sensor_(sensor), effects_(effects), expected_e_(std::max(expected_e, 0.0)) {
  const double width = effects.shot_noise ? 20 * std::sqrt(expected_e_) + 60 : 1;
  const double read_e = effects.read_noise ? sensor.read_noise_e : 0;
  const Sensor delivered = delivered_sensor(sensor, effects);
  const double steps = (width + 2 * reach_sigmas * read_e) / delivered.gain_e_per_dn + 2;
  if (!(width * std::min(steps, 65536.0) <= most_terms)) return;
  const Counts counts = effects.shot_noise ? poisson_counts(expected_e_) : Counts{expected_e_, {1}};

  const DetectorEffects rounding{false, false, effects.quantisation};
  RandomStream none(0, 0, 0);
  const auto dn_of = [&](double electrons) {
    return static_cast<int>(read_pixel(sensor, rounding, electrons, none));
  };
  const double last = counts.first + static_cast<double>(counts.probability.size()) - 1;
  const auto dn_beyond = [&](double electrons, double sigmas) {
    const double dn =
        (std::min(electrons, sensor.full_well_e) + sigmas * read_e) / delivered.gain_e_per_dn +
        delivered.offset_dn;
    return static_cast<int>(std::round(std::clamp(dn, 0.0, std::ldexp(1.0, delivered.bits) - 1)));
  };
  first_dn_ = dn_beyond(counts.first, -reach_sigmas);
  std::vector<double> cumulative(dn_beyond(last, reach_sigmas) - first_dn_ + 1, 0.0);
  for (std::size_t k = 0; k < counts.probability.size(); ++k) {
    const double electrons = std::min(counts.first + static_cast<double>(k), sensor.full_well_e);
    for (std::size_t d = 0; d < cumulative.size(); ++d) {
      const int dn = first_dn_ + static_cast<int>(d);
      const double edge_e = (dn + 0.5 - delivered.offset_dn) * delivered.gain_e_per_dn;
      const double share =
          read_e > 0 ? below((edge_e - electrons) / read_e) : (dn_of(electrons) <= dn ? 1.0 : 0.0);
      cumulative[d] += counts.probability[k] * share;
    }
  }
  tabulate(cumulative);
}

void ReadingTable::tabulate(const std::vector<double>& cumulative) {
  for (const double share : cumulative)
    limits_.push_back(static_cast<std::uint64_t>(std::min(share, 1.0) * 0x1p48));
  unsure_ = static_cast<std::uint16_t>(first_dn_ + static_cast<int>(limits_.size()));
  constexpr unsigned shift = 48 - quick_bits;
  quick_.resize(std::size_t{1} << quick_bits);
  std::size_t outcome = 0;  // of the lowest number with these bits
  for (std::uint64_t i = 0; i < quick_.size(); ++i) {
    const auto reached = [&](std::uint64_t u) {
      return outcome + 1 < limits_.size() && limits_[outcome] <= u;
    };
    while (reached(i << shift)) ++outcome;
    const bool is_sure = !reached(((i + 1) << shift) - 1);
    quick_[i] =
        is_sure ? static_cast<std::uint16_t>(first_dn_ + static_cast<int>(outcome)) : unsure_;
  }
}

std::uint16_t ReadingTable::reading_at(std::uint64_t u) const {
  const auto above = std::upper_bound(limits_.begin(), limits_.end() - 1, u);
  return static_cast<std::uint16_t>(first_dn_ + (above - limits_.begin()));
}

std::uint16_t ReadingTable::draw(RandomStream& random) const {
  if (limits_.empty()) return read_pixel(sensor_, effects_, expected_e_, random);
  return limits_.size() == 1 ? static_cast<std::uint16_t>(first_dn_)
                             : reading_of(random.bits32() >> 16, random);
}

void ReadingTable::draw(std::span<const std::uint32_t> words, RandomStream& more,
                        std::span<std::uint16_t> readings) const {
  if (limits_.empty()) {
    for (std::uint16_t& dn : readings) dn = draw(more);
  } else if (limits_.size() == 1) {
    std::fill(readings.begin(), readings.end(), static_cast<std::uint16_t>(first_dn_));
  } else {
    const std::size_t pairs = readings.size() / 2;
    for (std::size_t i = 0; i < pairs; ++i) {
      readings[2 * i] = reading_of(words[i] >> 16, more);
      readings[2 * i + 1] = reading_of(words[i] & 0xFFFF, more);
    }
    if (readings.size() % 2 != 0) readings.back() = reading_of(words[pairs] >> 16, more);
  }
}

}  // namespace scan::synth
