// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulsed_lidar_recorder.h"

#include <algorithm>
#include <limits>

#include "synth/scanners/first_surface.h"

namespace scan::synth {
namespace {

// Less light than this changes a reading in one of a million samples, by one electron.
constexpr double least_signal_e = 1e-6;

}  // namespace

LidarScan prepare_scan(const LidarBeam& beam, const RenderAddress& address,
                       const EffectSet& effects) {
  const PulsedLidar& s = beam.scanner;
  const Scene& scene = beam.caster.scene();
  const DetectorEffects reading = detector_effects(effects);
  LidarScan scan{.beam = beam,
                 .axis = sample_axis(s),
                 .reading = reading,
                 .address = address,
                 .dark = ReadingTable(s.sensor, reading, s.ambient_electrons),
                 .fog = {},
                 .paths = {}};
  if (LidarPaths::needed(s, scene, effects)) scan.paths.emplace(s, beam.caster, effects, scan.axis);
  const bool known = !scan.paths || scan.paths->straight_is_known();
  if (known && effects.has(Effect::medium) && scene.medium)
    scan.fog.emplace(s, *scene.medium, scan.axis);
  return scan;
}

LidarRecorder::LidarRecorder(const LidarScan& scan)
    : scan_(scan),
      signal_e_(static_cast<std::size_t>(scan.axis.samples), 0.0),
      readings_(signal_e_.size()) {}

std::span<const std::uint16_t> LidarRecorder::read(const Pose& world_from_scanner,
                                                   const Eigen::Vector3d& direction,
                                                   std::size_t ray) {
  const SampleRange lit = light(world_from_scanner, direction, ray);
  const PulsedLidar& s = scan_.beam.scanner;
  RandomStream random(scan_.address.seed, scan_.address.scan, ray);
  const std::span<std::uint16_t> readings(readings_);
  scan_.dark.draw(random, readings.first(lit.first));
  for (std::size_t i = lit.first; i < lit.behind; ++i) {
    const double expected_e = s.ambient_electrons + signal_e_[i];
    readings_[i] = signal_e_[i] > least_signal_e
                       ? read_pixel(s.sensor, scan_.reading, expected_e, random)
                       : scan_.dark.draw(random);
    signal_e_[i] = 0;
  }
  scan_.dark.draw(random, readings.subspan(lit.behind));
  return readings_;
}

SampleRange LidarRecorder::light(const Pose& world_from_scanner, const Eigen::Vector3d& direction,
                                 std::size_t ray) {
  const PulsedLidar& s = scan_.beam.scanner;
  const LidarPaths::Beam beam{world_from_scanner, direction, scan_.address, ray};
  SampleRange lit{signal_e_.size(), 0};
  echoes_.clear();
  walk_.clear();
  if (!scan_.paths || scan_.paths->straight_is_known())
    lit = straight_light(world_from_scanner, direction);
  if (s.range_walk.per_decade_s != 0) {
    arrivals_ = echoes_;
    if (scan_.paths) scan_.paths->find(beam, arrivals_, memory_);
    walk_ = delayed_pulses(s.range_walk, s.pulse_sigma_s, arrivals_);
  }
  for (Echo& echo : echoes_) {
    echo.time_s += delay_s(walk_, echo.time_s);
    const SampleRange touched = add_echo(scan_.axis, echo, signal_e_);
    lit = {std::min(lit.first, touched.first), std::max(lit.behind, touched.behind)};
  }
  if (scan_.paths) {
    quality_ += scan_.paths->add(beam, walk_, signal_e_, memory_);
    lit = {0, signal_e_.size()};
  }
  return {std::min(lit.first, lit.behind), lit.behind};
}

SampleRange LidarRecorder::straight_light(const Pose& world_from_scanner,
                                          const Eigen::Vector3d& direction) {
  scan_.beam.echoes(world_from_scanner, direction, echoes_);
  if (!scan_.fog) return {signal_e_.size(), 0};
  const auto end = first_surface(scan_.beam.caster, world_from_scanner, {.direction = direction});
  const double far_m = end ? end->point.norm() : std::numeric_limits<double>::infinity();
  scan_.fog->dim(echoes_);
  return scan_.fog->add(far_m, signal_e_);
}

}  // namespace scan::synth
