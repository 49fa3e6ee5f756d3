// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A pulsed lidar that digitises each echo.
#pragma once

#include <vector>

#include "libscan/core/raw_frames.h"
#include "synth/detector.h"
#include "synth/ray_caster.h"
#include "synth/scanners/pulsed_lidar_pattern.h"
#include "synth/scanners/rendering.h"

namespace scan::synth {

// The detector's delay grows with the logarithm of a pulse's energy N in electrons, as that of a
// compressing amplifier (per_decade_s < 0: strong pulses come early): per_decade_s log10(max(N, 1)
// / at_electrons). Light that arrives within 4 pulse sigmas of other light, on whatever way, is
// delayed with it as one pulse. What fog scatters back once is no pulse and not delayed.
struct RangeWalk {
  double per_decade_s = 0;
  double at_electrons = 1000;  // where the delay is 0
  bool is_calibrated = false;  // the frames tell the law, and decoding takes it back
};
// What the digitiser keeps: `samples` of them, a quarter before the first reading of at least
// threshold_electrons above the ambient light (none: the window's first); 0: the whole window.
struct LidarGate {
  int samples = 0;
  double threshold_electrons = 50;
};

// The beam is Gaussian with the 1/e^2 radius D(R) = hypot(exit_radius_m, tan(divergence_rad / 2)
// R). An echo's energy obeys the range equation of an extended target, N = electrons_at_10m * pi f
// * cos(incidence) * (10 m / R)^2 with the BSDF f straight back (pi f is a Lambert surface's
// albedo), per sub-ray with the sub-ray's share; its time is 2 R / c with R the distance of the
// place hit from the scanner's origin. Surfaces at several ranges inside one footprint give several
// echoes. Fog takes exp(-2 extinction R) of an echo and adds what it scatters back itself (once:
// soft_target.h) up to where the beam's centre ends. Sample i is the integral over one interval
// around window_start_s + i sample_interval_s; the window reaches from min_range_m to max_range_m
// and 4 pulse sigmas beyond.
struct PulsedLidar {
  std::variant<RasterPattern, SpinningPattern> pattern;
  double pulse_sigma_s = 1.5e-9;
  double sample_interval_s = 1e-9;
  double electrons_at_10m =
      5000;                      // total of the echo of a white target that faces the beam at 10 m
  double ambient_electrons = 5;  // per sample, whatever the beam meets
  // Per sample, of a white surface under 1 W/m^2 by the scene's lights.
  double electrons_per_w_m2 = 0;
  double divergence_rad = 0;  // full 1/e^2 angle of the Gaussian beam
  double exit_radius_m = 0;   // 1/e^2
  int sub_rays = 1;  // per cross-section: so many rings, squared as many rays; 1: the centre
  LidarMotion motion;
  RangeWalk range_walk;
  LidarGate gate;
  // The receiver's view and the beam become one here; nearer fog sends nothing back.
  double overlap_m = 0.5;
  Sensor sensor;
  double min_range_m = 0.5;
  double max_range_m = 50;
  double wavelength_m = 905e-9;
};

void check(const PulsedLidar& scanner);

// Mean electrons of each sample of one ray by all its sub-rays, `direction` unit in the scanner
// frame, the detector ideal.
std::vector<double> expected_waveform(const PulsedLidar& scanner, const RayCaster& caster,
                                      const Pose& world_from_scanner,
                                      const Eigen::Vector3d& direction);

Rendering render(const PulsedLidar& scanner, const RayCaster& caster,
                 const Pose& world_from_scanner, const RenderAddress& address,
                 const EffectSet& effects);
// Along the beams' centres, from where the scanner was at each pulse.
std::vector<RayTruth> true_rays(const PulsedLidar& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner);

}  // namespace scan::synth
