// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The echoes of one pulse and the waveform that they add up to.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "synth/scanners/pulse_table.h"
#include "synth/scanners/pulsed_lidar_beam.h"

namespace scan::synth {

struct Echo {
  double time_s = 0;
  double electrons = 0;
  double sigma_s = 0;  // of its Gaussian
};

// The window's samples: sample i is the integral over one interval around start_s + i interval_s.
struct SampleAxis {
  double start_s = 0;
  double interval_s = 0;
  double samples = 0;  // may exceed what an integer holds
};
SampleAxis sample_axis(const PulsedLidar& scanner);

// Adds the echo's Gaussian, integrated over each sample's interval. Returns the samples touched.
SampleRange add_echo(const SampleAxis& axis, const Echo& echo, std::span<double> samples);

// A beam on its way.
struct Pulse {
  std::size_t ray = 0;                       // its number in the scan
  const Pose* world_from_scanner = nullptr;  // as it is fired
  Eigen::Vector3d direction;                 // unit, scanner frame
};
// Their echoes: those of pulse i end before ends[i].
struct PulseEchoes {
  std::vector<Echo> echoes;
  std::vector<std::size_t> ends;
};

// One beam in one scene. `world_from_scanner` as the ray is fired.
struct LidarBeam {
  const PulsedLidar& scanner;
  const RayCaster& caster;
  const BeamSection& section;

  // By all sub-rays.
  void sub_ray_echoes(const Pose& world_from_scanner, const Eigen::Vector3d& direction,
                      std::vector<Echo>& echoes) const;
  // The same where the footprint needs it, else one echo in closed form. A pilot (the centre and
  // six rays on the outermost ring) must see a surface that is smooth and even to within a tenth of
  // what the echo's own shot noise leaves uncertain: 0.1 sigma / sqrt(N) in time, 0.1 sqrt(N) in
  // energy. A plane under the Gaussian beam then widens the pulse to sigma^2 + (2 / c)^2 |g|^2 / 4
  // with g the change of range per D across the beam. What hides between the pilot's rays is not
  // seen.
  void echoes(const Pose& world_from_scanner, const Eigen::Vector3d& direction,
              std::vector<Echo>& echoes) const;
  // Of neighbouring pulses, their rays traced together.
  void echoes(std::span<const Pulse> pulses, PulseEchoes& found) const;

 private:
  std::optional<Echo> echo_of(const Pose& world_from_scanner, const BeamRay& ray,
                              const std::optional<Hit>& hit) const;
  void trace(const Pose& world_from_scanner, std::span<const BeamRay> rays,
             std::span<std::optional<Echo>> echoes) const;
  void centre_echoes(std::span<const Pulse> pulses, PulseEchoes& found) const;
  std::optional<Echo> closed_form(const Pose& world_from_scanner,
                                  const Eigen::Vector3d& direction) const;
};

}  // namespace scan::synth
