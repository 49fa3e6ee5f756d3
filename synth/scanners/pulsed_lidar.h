// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A pulsed lidar that digitises each echo.
#pragma once

#include <variant>
#include <vector>

#include "libscan/core/raw_frames.h"
#include "synth/detector.h"
#include "synth/ray_caster.h"
#include "synth/scanners/render_address.h"

namespace scan::synth {

// Rows of equal elevation, columns of equal azimuth, over a field of view about +z (x right, y down).
struct RasterPattern {
  int rows = 120;
  int columns = 160;
  double height_rad = 0.6;
  double width_rad = 0.8;
};
// `rows` beams fanned over the elevation, each turned through the full circle about the scanner's y axis.
struct SpinningPattern {
  int rows = 32;
  int columns = 720;
  double lowest_rad = -0.3;
  double highest_rad = 0.3;
};

struct PulsedLidar {
  std::variant<RasterPattern, SpinningPattern> pattern;
  double pulse_sigma_s = 1.5e-9;
  double sample_interval_s = 1e-9;
  double electrons_at_10m = 5000;  // total of the echo of a white target that faces the beam at 10 m
  double ambient_electrons = 5;    // per sample
  double divergence_rad = 0;       // full 1/e^2 angle of the Gaussian beam
  double exit_radius_m = 0;        // 1/e^2
  int sub_rays = 1;                // over the beam's cross-section; 1: its centre only
  Sensor sensor;
  double min_range_m = 0.5;
  double max_range_m = 50;
};

void check(const PulsedLidar& scanner);
RawFrames render(const PulsedLidar& scanner, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const DetectorEffects& effects);
std::vector<RayTruth> true_rays(const PulsedLidar& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner);

}  // namespace scan::synth
