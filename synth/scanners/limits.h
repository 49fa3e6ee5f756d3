// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Checks of a scanner's fields that name field, value and limit.
#pragma once

#include <string>

#include "libscan/core/raw_frames.h"

namespace scan::synth {

// Each throws scan::Error "<field>: <value>, must be <limit>"; `field` names the scanner as well,
// as in "stereo_pair/focus_m". A NaN or an infinity never passes.
void require_positive(const std::string& field, double value);
void require_finite(const std::string& field, double value);
void require_within(const std::string& field, double value, double lowest, double highest);

// The fields of a sensor with at most `most_bits` bits; `device` is the scanner's name.
void require_sensor(const std::string& device, const Sensor& sensor, int most_bits);

// Refuses (Trouble::resource) frames of more than 2^31 numbers.
void require_size(const std::string& field, double numbers);

}  // namespace scan::synth
