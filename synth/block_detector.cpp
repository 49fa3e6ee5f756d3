// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/block_detector.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan::synth {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Of the read noise, electrons: from here on the law holds for every mean; from here on the steps
// of single electrons drown, and the mean alone must be large.
constexpr double strong_noise_e = 4, smooth_noise_e = 1;
constexpr double large_mean_e = 50;
constexpr double largest_count_e = 1e9;  // that the kernel rounds to a whole number

ReadingLaw reading_law(const Sensor& sensor, const DetectorEffects& effects) {
  const Sensor delivered = delivered_sensor(sensor, effects);
  const double read_e = effects.read_noise ? sensor.read_noise_e : 0;
  ReadingLaw law{.kind = ReadingLaw::Kind::sum,
                 .shot = effects.shot_noise ? 1.0 : 0.0,
                 .variance_e2 = read_e * read_e,
                 .least_e = -infinity,
                 .most_e = infinity,
                 .low_e = 0,
                 .high_e = sensor.full_well_e,
                 .dn_per_e = 1 / delivered.gain_e_per_dn,
                 .offset_dn = delivered.offset_dn,
                 .largest_dn = std::ldexp(1.0, delivered.bits) - 1};
  if (!effects.shot_noise) {
    if (read_e == 0) law.kind = ReadingLaw::Kind::exact;
    return law;
  }
  // 8 sigma below the full well: e + 8 sqrt(e) = full well
  law.most_e = std::pow(std::sqrt(16 + sensor.full_well_e) - 4, 2);
  law.high_e = law.most_e;
  if (read_e >= strong_noise_e) return law;
  law.least_e = law.low_e = large_mean_e;
  if (read_e >= smooth_noise_e) return law;
  law.kind = ReadingLaw::Kind::count;
  law.variance_e2 = -1.0 / 12;
  law.most_e = law.high_e = std::min(law.most_e, largest_count_e);
  if (read_e > 0) law.least_e = infinity;  // two normal numbers would be needed
  return law;
}

}  // namespace

BlockDetector::BlockDetector(const Sensor& sensor, const DetectorEffects& effects)
    : law_(reading_law(sensor, effects)) {}

}  // namespace scan::synth
