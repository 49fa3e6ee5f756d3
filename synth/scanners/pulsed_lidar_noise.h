// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How noise of a lidar's samples becomes an error of range: the Cramer-Rao bounds of a Gaussian
// echo.
#pragma once

#include "synth/scanners/pulsed_lidar.h"

namespace scan::synth {

// An echo of N electrons as it is recorded, and what the decoder makes of it: it fits a Gaussian of
// `width` to the 3 width + 2 samples on either side.
struct EchoNoise {
  double width;         // standard deviation, samples
  double height_e;      // its highest sample
  double m_per_sample;  // of range
  double total_e;

  double shot_m() const;                     // 1 sigma of range by the echo's own shot noise
  double white_m(double variance_e2) const;  // by white noise in each sample
  double all_m(double variance_e2) const;
  double half_window_m() const;
};

EchoNoise echo_noise(const PulsedLidar& scanner, double electrons);  // less than one counts as one

double read_variance_e2(const PulsedLidar& scanner);
// Of a sample without any light of the pulse: ambient light, read noise, rounding.
double floor_variance_e2(const PulsedLidar& scanner);

}  // namespace scan::synth
