// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/sensor_model.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "libscan/core/error.h"
#include "libscan/core/median.h"

namespace scan::decoding {
namespace {

void require(bool holds, const char* field, double value, const char* limit) {
  if (holds) return;
  throw Error(Trouble::input,
              std::string("sensor/") + field + ": " + std::to_string(value) + ", must be " + limit);
}

}  // namespace

void check(const Sensor& s) {
  require(s.gain_e_per_dn > 0 && std::isfinite(s.gain_e_per_dn), "gain_e_per_dn", s.gain_e_per_dn,
          "positive");
  require(std::isfinite(s.offset_dn), "offset_dn", s.offset_dn, "finite");
  require(s.read_noise_e >= 0 && std::isfinite(s.read_noise_e), "read_noise_e", s.read_noise_e,
          "0 or more");
  require(s.full_well_e > 0, "full_well_e", s.full_well_e, "positive");
  require(s.bits >= 1 && s.bits <= 16, "bits", s.bits, "1 to 16");
}

double electrons(const Sensor& s, double dn) {
  return (dn - s.offset_dn) * s.gain_e_per_dn;
}

double variance_e2(const Sensor& s, double expected_e) {
  return std::max(expected_e, 0.0) + s.read_noise_e * s.read_noise_e +
         s.gain_e_per_dn * s.gain_e_per_dn / 12;
}

double saturation_dn(const Sensor& s) {
  return std::min(std::exp2(s.bits) - 1, std::round(s.full_well_e / s.gain_e_per_dn + s.offset_dn));
}

double Background::threshold_e(double sigmas, double count) const {
  const double half = sigmas * sigmas * shot_share / 6;
  return half + std::sqrt(half * half + sigmas * sigmas * count * variance_e2);
}

Background estimate_background(std::span<const double> readings_e, const Sensor& sensor) {
  constexpr double sigma_per_deviation = 1.4826;  // of the median absolute deviation, normal noise
  std::vector<double> scratch(readings_e.begin(), readings_e.end());
  const double middle = median(scratch);
  for (double& value : scratch) value = std::abs(value - middle);
  // One electron more than the median: when most readings are 0 the median hides a mean below 1.
  const double clip = 3 * std::max(sigma_per_deviation * median(scratch),
                                   std::sqrt(variance_e2(sensor, std::max(middle, 0.0) + 1)));
  double sum = 0, sum2 = 0, count = 0;
  for (const double value : readings_e) {
    if (!(std::abs(value - middle) <= clip)) continue;
    sum += value - middle;
    sum2 += (value - middle) * (value - middle);
    ++count;
  }
  const double mean = sum / count;  // the median itself is within the clip: count >= 1
  Background background;
  background.level_e = middle + mean;
  background.variance_e2 =
      std::max(sum2 / count - mean * mean, variance_e2(sensor, background.level_e));
  background.shot_share = std::clamp(background.level_e / background.variance_e2, 0.0, 1.0);
  return background;
}

}  // namespace scan::decoding
