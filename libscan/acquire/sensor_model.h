// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a digital number says in electrons, and how noisy it is.
#pragma once

#include <span>

#include "libscan/core/raw_frames.h"

namespace scan::decoding {

// Throws scan::Error (input) naming the field that is out of its domain.
void check(const Sensor& sensor);

double electrons(const Sensor& sensor, double dn);

// Variance of one reading whose expectation is `expected_e` electrons: shot noise, read noise and
// rounding to whole numbers (1/12 of a step squared; EMVA 1288). Never zero.
double variance_e2(const Sensor& sensor, double expected_e);

// The digital number of a full pixel: readings at or above it are clipped.
double saturation_dn(const Sensor& sensor);

// The dark part of a row of readings.
struct Background {
  double level_e = 0;
  double variance_e2 = 0;  // of one reading
  double shot_share = 0;   // of the variance that is Poisson, 0 to 1

  // How far the sum of `count` readings must exceed count * level_e so that chance explains it no
  // more often than `sigmas` of a normal variable. For few photons the Poisson tail is longer than
  // the normal one: Bernstein's inequality, t^2 = k^2 (variance + shot_share t / 3), solved for t.
  double threshold_e(double sigmas, double count) const;
};

// Mean and variance of the readings within three (robust) standard deviations of the median, the
// variance never below the sensor's own. Right as long as the signal fills less than half the row.
Background estimate_background(std::span<const double> readings_e, const Sensor& sensor);

}  // namespace scan::decoding
