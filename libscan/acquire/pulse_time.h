// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The first echo of a digitised waveform and its time, in samples.
#pragma once

#include <span>
#include <string_view>

#include "libscan/acquire/gaussian_fit.h"
#include "libscan/acquire/sensor_model.h"
#include "libscan/acquire/waveform.h"

namespace scan::decoding {

struct PulseTime {
  std::string_view miss = {};
  double sample = 0;  // place of the pulse's middle; 0 is the first sample
  double sigma_samples = 0;
  double height_e = 0;  // above the background
};

// `waveform_e` in electrons, `pulse_sigma` in samples. The echo is found in the correlation with
// the pulse (the linear filter of best signal to noise); its top is where the correlation has
// fallen again by more than its noise. An echo whose +-2 pulse_sigma are not all recorded is a miss
// (border).
PulseTime locate_pulse(std::span<const double> waveform_e, double pulse_sigma, const Sensor& sensor,
                       const WaveformOptions& options);

// Time of half the height on the rising flank plus sqrt(2 ln 2) sigma, the pulse's middle: a
// constant fraction discriminator. Samples are interpolated by the Gaussian through two of them,
// which is exact for a Gaussian pulse. None if the flank does not stand above the background.
std::optional<Location> leading_edge(const Samples& samples, const Gaussian& start);

}  // namespace scan::decoding
