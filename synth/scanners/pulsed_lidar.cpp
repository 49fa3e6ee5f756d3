// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulsed_lidar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "libscan/core/parallel.h"
#include "synth/scanners/first_surface.h"
#include "synth/scanners/limits.h"
#include "synth/scanners/pixel_grid.h"
#include "synth/scanners/pulsed_lidar_recorder.h"

namespace scan::synth {
namespace {

constexpr std::size_t rays_at_once = 64;

void check_pattern(const PulsedLidar& s) {
  const RayGrid grid = ray_grid(s);
  require_within("pulsed_lidar/pattern.rows", static_cast<int>(grid.rows), 1, 1e6);
  require_within("pulsed_lidar/pattern.columns", static_cast<int>(grid.columns), 1, 1e6);
  if (const auto* raster = std::get_if<RasterPattern>(&s.pattern)) {
    require_within("pulsed_lidar/pattern.height_rad", raster->height_rad, 0, std::numbers::pi);
    require_within("pulsed_lidar/pattern.width_rad", raster->width_rad, 0, 2 * std::numbers::pi);
  } else {
    const auto& spinning = std::get<SpinningPattern>(s.pattern);
    const double right_angle = std::numbers::pi / 2;
    require_within("pulsed_lidar/pattern.lowest_rad", spinning.lowest_rad, -right_angle,
                   right_angle);
    require_within("pulsed_lidar/pattern.highest_rad", spinning.highest_rad, spinning.lowest_rad,
                   right_angle);
  }
}

void check(const LidarMotion& motion) {
  require_within("pulsed_lidar/motion.interval_s", motion.interval_s, 0, 1e3);
  for (int axis = 0; axis < 3; ++axis) {
    require_within("pulsed_lidar/motion.velocity_m_s", motion.velocity_m_s[axis], -1e5, 1e5);
    require_within("pulsed_lidar/motion.angular_velocity_rad_s",
                   motion.angular_velocity_rad_s[axis], -1e5, 1e5);
  }
}

// Of the pulse as recorded: the variance of the sampling interval, h^2 / 12, adds to the pulse's
// own.
double recorded_sigma_s(const PulsedLidar& s) {
  return std::sqrt(s.pulse_sigma_s * s.pulse_sigma_s +
                   s.sample_interval_s * s.sample_interval_s / 12);
}

// The device as far as the effects let it be.
PulsedLidar with_effects(PulsedLidar s, const EffectSet& effects) {
  if (!effects.has(Effect::footprint)) s.sub_rays = 1;
  if (!effects.has(Effect::motion)) s.motion = {};
  if (!effects.has(Effect::range_walk)) s.range_walk = {};
  return s;
}

// Where the gate opens: a quarter of it before the first reading at the threshold.
std::uint32_t gate_start(std::span<const std::uint16_t> readings, int samples, double least_dn) {
  const auto above = std::find_if(readings.begin(), readings.end(),
                                  [&](std::uint16_t dn) { return dn >= least_dn; });
  if (above == readings.end()) return 0;
  const auto trigger = above - readings.begin();
  const auto last = static_cast<std::ptrdiff_t>(readings.size()) - samples;
  return static_cast<std::uint32_t>(std::clamp<std::ptrdiff_t>(trigger - samples / 4, 0, last));
}

double gate_dn(const PulsedLidar& s, const Sensor& delivered) {
  return (s.ambient_electrons + s.gate.threshold_electrons) / delivered.gain_e_per_dn +
         delivered.offset_dn;
}

RenderStatistics statistics_of(const LidarPaths::Quality& quality) {
  return {
      .paths = static_cast<std::uint64_t>(quality.paths),
      .sampling_error_rms = quality.readings > 0 ? std::sqrt(quality.square / quality.readings) : 0,
      .sampling_error_max = quality.largest};
}

Waveforms empty_frames(const PulsedLidar& s, const SampleAxis& axis,
                       const DetectorEffects& reading) {
  Waveforms frames{.calibration = {.sample_interval_s = axis.interval_s,
                                   .window_start_s = axis.start_s,
                                   .pulse_sigma_s = recorded_sigma_s(s),
                                   .sensor = delivered_sensor(s.sensor, reading)},
                   .grid = ray_grid(s),
                   .directions = ray_directions(s)};
  if (s.range_walk.is_calibrated) {
    frames.calibration.range_walk_s = s.range_walk.per_decade_s;
    frames.calibration.range_walk_electrons = s.range_walk.at_electrons;
  }
  const std::size_t rays = frames.directions.size();
  frames.samples_per_ray =
      s.gate.samples > 0 ? s.gate.samples : static_cast<std::uint32_t>(axis.samples);
  frames.samples.resize(rays * frames.samples_per_ray);
  if (s.gate.samples > 0) frames.first_sample.resize(rays);
  if (is_moving(s) && s.motion.is_measured)
    for (std::size_t ray = 0; ray < rays; ++ray)
      frames.scanner_from_ray.push_back(scan_from_scanner(s, ray));
  return frames;
}

// Keeps of whole windows, one after the other, what the gate lets through.
void keep_gated(const PulsedLidar& s, std::span<const Pulse> pulses,
                std::span<const std::uint16_t> windows, Waveforms& frames) {
  const double least_dn = gate_dn(s, frames.calibration.sensor);
  const std::size_t kept = frames.samples_per_ray, whole = windows.size() / pulses.size();
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    const auto window = windows.subspan(i * whole, whole);
    const std::uint32_t start = gate_start(window, s.gate.samples, least_dn);
    frames.first_sample[pulses[i].ray] = start;
    std::copy_n(&window[start], kept, &frames.samples[pulses[i].ray * kept]);
  }
}

// Records pulses [begin, end) in the order that they are best traced in.
LidarPaths::Quality record(const LidarScan& scan, const Pose& world_from_scanner, std::size_t begin,
                           std::size_t end, Waveforms& frames) {
  const PulsedLidar& s = scan.beam.scanner;
  const bool moving = is_moving(s), gated = s.gate.samples > 0;
  const auto columns = static_cast<int>(frames.grid.columns);
  TileWalk walk(begin, columns, static_cast<int>(frames.grid.rows));
  LidarRecorder recorder(scan);
  std::vector<Pulse> pulses;
  std::vector<Pose> poses(moving ? rays_at_once : 0);
  std::vector<std::uint16_t> whole(gated ? rays_at_once * recorder.samples() : 0);
  std::array<std::uint16_t*, rays_at_once> windows;
  for (std::size_t first = begin; first < end; first += rays_at_once) {
    const std::size_t count = std::min(rays_at_once, end - first);
    pulses.clear();
    for (std::size_t k = 0; k < count; ++k, walk.next()) {
      const std::size_t ray = index_of(walk.place(), columns);
      if (moving) poses[k] = world_from_scanner * scan_from_scanner(s, ray);
      pulses.push_back({ray, moving ? &poses[k] : &world_from_scanner, frames.directions[ray]});
      windows[k] =
          gated ? &whole[k * recorder.samples()] : &frames.samples[ray * recorder.samples()];
    }
    recorder.read(pulses, windows);
    if (gated) keep_gated(s, pulses, std::span(whole).first(count * recorder.samples()), frames);
  }
  return recorder.quality();
}

}  // namespace

void check(const PulsedLidar& s) {
  check_pattern(s);
  require_positive("pulsed_lidar/pulse_sigma_s", s.pulse_sigma_s);
  require_positive("pulsed_lidar/sample_interval_s", s.sample_interval_s);
  require_within("pulsed_lidar/electrons_at_10m", s.electrons_at_10m, 0, 1e12);
  require_within("pulsed_lidar/ambient_electrons", s.ambient_electrons, 0, 1e9);
  require_within("pulsed_lidar/electrons_per_w_m2", s.electrons_per_w_m2, 0, 1e12);
  require_within("pulsed_lidar/divergence_rad", s.divergence_rad, 0, 1);
  require_within("pulsed_lidar/exit_radius_m", s.exit_radius_m, 0, 1);
  require_within("pulsed_lidar/sub_rays", s.sub_rays, 1, 64);
  check(s.motion);
  require_within("pulsed_lidar/range_walk.per_decade_s", s.range_walk.per_decade_s, -1e-6, 1e-6);
  require_positive("pulsed_lidar/range_walk.at_electrons", s.range_walk.at_electrons);
  require_sensor("pulsed_lidar", s.sensor, 16);
  require_positive("pulsed_lidar/overlap_m", s.overlap_m);
  require_positive("pulsed_lidar/wavelength_m", s.wavelength_m);
  require_within("pulsed_lidar/min_range_m", s.min_range_m, 0, 1e9);
  require_within("pulsed_lidar/max_range_m", s.max_range_m, s.min_range_m, 1e9);
  const RayGrid grid = ray_grid(s);
  const double samples = sample_axis(s).samples;
  if (s.gate.samples != 0) {
    require_within("pulsed_lidar/gate.samples", s.gate.samples, 16, samples);
    require_positive("pulsed_lidar/gate.threshold_electrons", s.gate.threshold_electrons);
  }
  require_size("pulsed_lidar/samples", samples);
  require_size("pulsed_lidar/rows * columns * samples",
               (s.gate.samples > 0 ? s.gate.samples : samples) * grid.rows * grid.columns);
}

std::vector<double> expected_waveform(const PulsedLidar& s, const RayCaster& caster,
                                      const Pose& world_from_scanner,
                                      const Eigen::Vector3d& direction) {
  const SampleAxis axis = sample_axis(s);
  std::vector<double> samples(static_cast<std::size_t>(axis.samples), s.ambient_electrons);
  std::vector<Echo> echoes;
  LidarBeam{s, caster, beam_section(s)}.sub_ray_echoes(world_from_scanner, direction, echoes);
  for (const Echo& echo : echoes) add_echo(axis, echo, samples);
  return samples;
}

Rendering render(const PulsedLidar& device, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects) {
  check(device);
  const PulsedLidar s = with_effects(device, effects);
  const BeamSection section = beam_section(s);
  const LidarBeam beam{s, caster, section};
  const LidarScan scan = prepare_scan(beam, address, effects);
  Waveforms frames = empty_frames(s, scan.axis, scan.reading);
  const auto quality = ordered_sum(frames.directions.size(), 8 * rays_at_once,
                                   LidarPaths::Quality{}, [&](std::size_t begin, std::size_t end) {
                                     return record(scan, world_from_scanner, begin, end, frames);
                                   });
  return {.frames = std::move(frames), .statistics = statistics_of(quality)};
}

std::vector<RayTruth> true_rays(const PulsedLidar& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner) {
  const std::vector<Eigen::Vector3d> directions = ray_directions(scanner);
  std::vector<RayTruth> rays(directions.size());
  const bool moving = is_moving(scanner);
  parallel_for(rays.size(), [&](std::size_t i) {
    const Pose pose = moving ? scan_from_scanner(scanner, i) : Pose::Identity();
    rays[i] = true_ray(caster, world_from_scanner,
                       {.origin = pose.translation(), .direction = pose.linear() * directions[i]});
  });
  return rays;
}

}  // namespace scan::synth
