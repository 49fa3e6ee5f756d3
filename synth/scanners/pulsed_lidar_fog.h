// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What homogeneous fog does to a lidar's waveforms, light scattered once.
#pragma once

#include <span>
#include <vector>

#include "synth/medium/soft_target.h"
#include "synth/scanners/pulsed_lidar_echo.h"

namespace scan::synth {

class LidarFog {
 public:
  LidarFog(const PulsedLidar& scanner, const Medium& medium, const SampleAxis& axis);

  // Of the echoes' energy what gets there and back.
  void dim(std::span<Echo> echoes) const;
  // Adds what the fog sends back from before `far_m`; returns the samples touched.
  SampleRange add(double far_m, std::span<double> samples) const;

 private:
  double returned_e(std::size_t sample, double far_m) const;

  SoftTarget target_;
  double pulse_sigma_s_;
  SampleAxis axis_;
  std::vector<double> endless_e_;  // without any surface
};

}  // namespace scan::synth
