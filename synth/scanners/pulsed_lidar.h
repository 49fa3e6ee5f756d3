// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A pulsed lidar that digitises each echo.
#pragma once

#include <variant>
#include <vector>

#include "libscan/core/raw_frames.h"
#include "synth/detector.h"
#include "synth/ray_caster.h"
#include "synth/scanners/rendering.h"

namespace scan::synth {

// Rows of equal elevation, columns of equal azimuth, over a field of view about +z (x right, y
// down): direction = (cos e sin a, sin e, cos e cos a) with a = width ((column + 1/2) / columns -
// 1/2) and e = height ((row + 1/2) / rows - 1/2); row 0 is the highest.
struct RasterPattern {
  int rows = 120;
  int columns = 160;
  double height_rad = 0.6;
  double width_rad = 0.8;
};
// `rows` beams fanned over the elevation, each turned through the full circle about the scanner's y
// axis: direction = (cos e sin a, -sin e, cos e cos a) with a = 2 pi column / columns and e in
// equal steps from highest_rad (row 0) to lowest_rad (last row); a single row lies in the middle.
struct SpinningPattern {
  int rows = 32;
  int columns = 720;
  double lowest_rad = -0.3;
  double highest_rad = 0.3;
};

// The beam is Gaussian with the 1/e^2 radius D(R) = hypot(exit_radius_m, tan(divergence_rad / 2)
// R). An echo's energy obeys the range equation of an extended Lambert target, N = electrons_at_10m
// * albedo * cos(incidence) * (10 m / R)^2, per sub-ray with the sub-ray's share; its time is 2 R /
// c with R the distance of the place hit from the scanner's origin. Surfaces at several ranges
// inside one footprint give several echoes. Sample i is the integral over one interval around
// window_start_s + i sample_interval_s; the window reaches from min_range_m to max_range_m and 4
// pulse sigmas beyond.
struct PulsedLidar {
  std::variant<RasterPattern, SpinningPattern> pattern;
  double pulse_sigma_s = 1.5e-9;
  double sample_interval_s = 1e-9;
  double electrons_at_10m =
      5000;                      // total of the echo of a white target that faces the beam at 10 m
  double ambient_electrons = 5;  // per sample
  double divergence_rad = 0;     // full 1/e^2 angle of the Gaussian beam
  double exit_radius_m = 0;      // 1/e^2
  int sub_rays = 1;  // per cross-section: so many rings, squared as many rays; 1: the centre
  Sensor sensor;
  double min_range_m = 0.5;
  double max_range_m = 50;
};

void check(const PulsedLidar& scanner);

// Unit directions in the scanner frame, one per ray, row by row.
std::vector<Eigen::Vector3d> ray_directions(const PulsedLidar& scanner);

// A ray of the beam's cross-section and the share of the energy that it carries; the shares add
// to 1.
struct BeamRay {
  Eigen::Vector3d origin;     // scanner frame, metres
  Eigen::Vector3d direction;  // unit
  double share = 1;
};
// About the axis `direction` (unit). Ring k has 2k + 1 rays, each with 1 / sub_rays^2 of the
// energy; the rays are skew lines of one-sheeted hyperboloids, so at every distance R they stand
// where the Gaussian of radius D(R) wants them, and their mean square distance from the axis is
// that of the Gaussian, D^2 / 2.
std::vector<BeamRay> beam_rays(const PulsedLidar& scanner, const Eigen::Vector3d& direction);

// Mean electrons of each sample of one ray, `direction` unit in the scanner frame.
std::vector<double> expected_waveform(const PulsedLidar& scanner, const RayCaster& caster,
                                      const Pose& world_from_scanner,
                                      const Eigen::Vector3d& direction);

Rendering render(const PulsedLidar& scanner, const RayCaster& caster,
                 const Pose& world_from_scanner, const RenderAddress& address,
                 const EffectSet& effects);
// Along the beams' centres.
std::vector<RayTruth> true_rays(const PulsedLidar& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner);

}  // namespace scan::synth
