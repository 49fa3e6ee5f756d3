// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_camera.h"

#include <cmath>

#include "libscan/core/parallel.h"
#include "synth/scanners/limits.h"
#include "synth/scanners/phase_readout.h"

namespace scan::synth {
namespace {

void check_light(const PhaseCamera& s) {
  require_positive("phase_camera/frequencies_hz (count)",
                   static_cast<double>(s.frequencies_hz.size()));
  for (const double frequency_hz : s.frequencies_hz)
    require_positive("phase_camera/frequencies_hz", frequency_hz);
  require_within("phase_camera/electrons_at_1m", s.electrons_at_1m, 0, 1e9);
  require_within("phase_camera/contrast", s.contrast, 0, 1);
  require_within("phase_camera/ambient_electrons", s.ambient_electrons, 0, 1e9);
  require_within("phase_camera/electrons_per_w_m2", s.electrons_per_w_m2, 0, 1e9);
  require_finite("phase_camera/emitter_offset_m", s.emitter_offset_m);
  double harmonics = 0;
  for (const double harmonic : s.harmonics) harmonics += std::abs(harmonic);
  require_within("phase_camera/harmonics (sum of absolute values)", harmonics, 0, 0.5);
}

void check_motion(const PhaseCamera& s) {
  require_within("phase_camera/tap_interval_s", s.tap_interval_s, 0, 1);
  for (int i = 0; i < 3; ++i) {
    require_finite("phase_camera/velocity_m_s", s.velocity_m_s[i]);
    require_finite("phase_camera/angular_velocity_rad_s", s.angular_velocity_rad_s[i]);
  }
}

void check_optics(const PhaseCamera& s) {
  require_within("phase_camera/vignetting", s.vignetting, 0, 1);
  require_within("phase_camera/aperture_m", s.aperture_m, 0, 1);
  require_positive("phase_camera/focus_m", s.focus_m);
  require_within("phase_camera/sub_rays", s.sub_rays, 1, 64);
}

PhaseTaps blank_frames(const PhaseCamera& s, const DetectorEffects& reading) {
  const Image<std::uint16_t> blank(s.camera.width_px, s.camera.height_px);
  PhaseTaps frames{.calibration = {.camera = s.camera,
                                   .frequencies_hz = s.frequencies_hz,
                                   .sensor = delivered_sensor(s.sensor, reading),
                                   .max_range_m = s.max_range_m},
                   .taps = {}};
  frames.taps.assign(s.frequencies_hz.size(), {blank, blank, blank, blank});
  return frames;
}

}  // namespace

void check(const PhaseCamera& s) {
  check(s.camera);
  check_light(s);
  require_size("phase_camera/camera.width_px * height_px * 4 * frequencies",
               4.0 * s.camera.width_px * s.camera.height_px * s.frequencies_hz.size());
  check_motion(s);
  check_optics(s);
  require_positive("phase_camera/wavelength_m", s.wavelength_m);
  require_finite("phase_camera/range_offset_m", s.range_offset_m);
  require_within("phase_camera/pixel_offset_m", s.pixel_offset_m, 0, 1);
  require_sensor("phase_camera", s.sensor, 16);
  require_positive("phase_camera/max_range_m", s.max_range_m);
}

PhaseCamera with_effects(const PhaseCamera& scanner, const EffectSet& effects) {
  PhaseCamera s = scanner;
  if (!effects.has(Effect::defocus)) s.aperture_m = 0;
  if (!effects.has(Effect::footprint) && s.aperture_m == 0) s.sub_rays = 1;
  if (!effects.has(Effect::wiggling)) s.harmonics.clear();
  if (!effects.has(Effect::motion)) s.tap_interval_s = 0;
  if (!effects.has(Effect::vignetting)) s.vignetting = 0;
  if (!effects.has(Effect::miscalibration)) s.range_offset_m = s.pixel_offset_m = 0;
  return s;
}

PixelPhasors expected_phasors(const PhaseCamera& s, const RayCaster& caster,
                              const Pose& world_from_scanner, int column, int row) {
  const std::vector<Tone> tones = tones_of(s);
  PixelPhasors pixel{.amplitude_e = std::vector<std::complex<double>>(tones.size())};
  const DirectLight light{s, caster.scene(), tones, world_from_scanner.linear().transpose(),
                          1.0 / (s.sub_rays * s.sub_rays)};
  ViewBatch batch;
  for (int i = 0; i < s.sub_rays * s.sub_rays; ++i) {
    batch.clear();
    if (const auto view = sub_ray(s, {column, row}, i)) batch.add(world_from_scanner, *view, 0);
    batch.trace(s, caster, world_from_scanner);
    if (batch.size() > 0) light.add(batch, 0, {pixel.constant_e, pixel.amplitude_e});
  }
  return pixel;
}

Rendering render(const PhaseCamera& device, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects) {
  check(device);
  const PhaseCamera s = with_effects(device, effects);
  const DetectorEffects reading = detector_effects(effects);
  PhaseTaps frames = blank_frames(s, reading);
  const PathNeed need = path_need(s, caster.scene(), effects);
  std::optional<LightTransport> transport;
  if (need != PathNeed::none) transport.emplace(caster, transport_options(effects, false));
  const std::vector<Exposure> exposures = exposures_of(s);
  SamplingError error;
  for (std::size_t e = 0; e < exposures.size(); ++e) {
    const Pose pose = moved(world_from_scanner, s, exposures[e].time_s);
    const Readout readout{s, caster, pose, exposures[e], e, address, reading, frames};
    if (transport)
      error += read_by_paths(readout, *transport, need);
    else
      read_direct_light(readout);
  }
  return {.frames = std::move(frames), .statistics = error.statistics()};
}

std::vector<RayTruth> true_rays(const PhaseCamera& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner) {
  const int width = scanner.camera.width_px;
  std::vector<RayTruth> rays(static_cast<std::size_t>(width) * scanner.camera.height_px);
  parallel_for(rays.size(), [&](std::size_t i) {
    const auto [column, row] = place_of(i, width);
    const auto toward = ray_through(scanner.camera, Eigen::Vector2d(column, row));
    if (toward) rays[i] = true_ray(caster, world_from_scanner, {.direction = toward->normalized()});
  });
  return rays;
}

}  // namespace scan::synth
