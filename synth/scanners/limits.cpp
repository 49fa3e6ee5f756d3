// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/limits.h"

#include <cmath>
#include <sstream>

#include "libscan/core/error.h"

namespace scan::synth {
namespace {

template <class... Parts>
[[noreturn]] void refuse(Trouble trouble, const Parts&... parts) {
  std::ostringstream message;
  message.precision(9);
  (message << ... << parts);
  throw Error(trouble, message.str());
}

constexpr double most_numbers = 2147483648.0;  // 2^31: 4 GiB of 16-bit numbers

}  // namespace

void require_positive(const std::string& field, double value) {
  if (!std::isfinite(value) || !(value > 0))
    refuse(Trouble::input, field, ": ", value, ", must be positive and finite");
}

void require_finite(const std::string& field, double value) {
  if (!std::isfinite(value)) refuse(Trouble::input, field, ": ", value, ", must be finite");
}

void require_within(const std::string& field, double value, double lowest, double highest) {
  if (!(value >= lowest && value <= highest))
    refuse(Trouble::input, field, ": ", value, ", must be from ", lowest, " to ", highest);
}

void require_sensor(const std::string& device, const Sensor& sensor, int most_bits) {
  require_positive(device + "/sensor.gain_e_per_dn", sensor.gain_e_per_dn);
  require_finite(device + "/sensor.offset_dn", sensor.offset_dn);
  require_within(device + "/sensor.read_noise_e", sensor.read_noise_e, 0, 1e9);
  require_positive(device + "/sensor.full_well_e", sensor.full_well_e);
  require_within(device + "/sensor.bits", sensor.bits, 1, most_bits);
}

void require_size(const std::string& field, double numbers) {
  if (!(numbers <= most_numbers))
    refuse(Trouble::resource, field, ": ", numbers, " numbers, must be at most ", most_numbers);
}

}  // namespace scan::synth
