// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_camera.h"

#include <cmath>

#include "libscan/core/parallel.h"
#include "libscan/core/units.h"
#include "synth/scanners/first_surface.h"
#include "synth/scanners/limits.h"
#include "synth/scanners/pixel_grid.h"

namespace scan::synth {
namespace {

std::optional<ScannerRay> pixel_ray(const PhaseCamera& s, const Eigen::Vector2d& place) {
  const auto toward = ray_through(s.camera, place);
  if (!toward) return std::nullopt;
  return ScannerRay{.direction = toward->normalized()};
}

// Electrons per tap that the device's own light brings back from a white surface.
double own_light(const PhaseCamera& s, const RayCaster& caster, const Pose& world_from_scanner,
                 const SeenSurface& seen, const Eigen::Vector3d& emitter) {
  const Eigen::Vector3d to_emitter = emitter - seen.point;
  const double cosine = seen.normal.dot(to_emitter.normalized());
  if (!(cosine > 0)) return 0;
  // A light at the lens lights all that the lens sees.
  if (s.emitter_offset_m != 0 && caster.occluded(seen.hit, world_from_scanner * emitter)) return 0;
  return s.electrons_at_1m * cosine / to_emitter.squaredNorm();
}

void add_ray(const PhaseCamera& s, const RayCaster& caster, const Pose& world_from_scanner,
             const ScannerRay& ray, PixelPhasors& sum) {
  const auto seen = first_surface(caster, world_from_scanner, ray);
  if (!seen) return;
  const Eigen::Vector3d emitter(s.emitter_offset_m, 0, 0);
  const double albedo = albedo_at(caster.scene(), seen->hit.object, seen->hit.point);
  const double own = albedo * own_light(s, caster, world_from_scanner, *seen, emitter);
  const double path_m = (emitter - seen->point).norm() + seen->point.norm();
  sum.constant_e += own + albedo * s.ambient_electrons;
  for (std::size_t f = 0; f < s.frequencies_hz.size(); ++f) {
    const double phase = 2 * std::numbers::pi * s.frequencies_hz[f] * path_m / speed_of_light_m_s;
    sum.amplitude_e[f] += std::polar(s.contrast * own, phase);
  }
}

// Re(amplitude exp(i k pi/2)) without the rounding of the angle: 0, 90, 180, 270 degrees.
double modulation(const std::complex<double>& amplitude, int tap) {
  const double values[] = {amplitude.real(), -amplitude.imag(), -amplitude.real(),
                           amplitude.imag()};
  return values[tap];
}

}  // namespace

void check(const PhaseCamera& s) {
  check(s.camera);
  require_positive("phase_camera/frequencies_hz (count)",
                   static_cast<double>(s.frequencies_hz.size()));
  for (const double frequency_hz : s.frequencies_hz)
    require_positive("phase_camera/frequencies_hz", frequency_hz);
  require_size("phase_camera/camera.width_px * height_px * 4 * frequencies",
               4.0 * s.camera.width_px * s.camera.height_px * s.frequencies_hz.size());
  require_within("phase_camera/electrons_at_1m", s.electrons_at_1m, 0, 1e9);
  require_within("phase_camera/contrast", s.contrast, 0, 1);
  require_within("phase_camera/ambient_electrons", s.ambient_electrons, 0, 1e9);
  require_finite("phase_camera/emitter_offset_m", s.emitter_offset_m);
  require_within("phase_camera/sub_rays", s.sub_rays, 1, 64);
  require_sensor("phase_camera", s.sensor, 16);
  require_positive("phase_camera/max_range_m", s.max_range_m);
}

PixelPhasors expected_phasors(const PhaseCamera& s, const RayCaster& caster,
                              const Pose& world_from_scanner, int column, int row) {
  PixelPhasors pixel{.amplitude_e = std::vector<std::complex<double>>(s.frequencies_hz.size())};
  for (int i = 0; i < s.sub_rays * s.sub_rays; ++i) {
    if (const auto ray = pixel_ray(s, sub_pixel({column, row}, i, s.sub_rays)))
      add_ray(s, caster, world_from_scanner, *ray, pixel);
  }
  pixel.constant_e /= s.sub_rays * s.sub_rays;
  for (auto& amplitude : pixel.amplitude_e) amplitude /= s.sub_rays * s.sub_rays;
  return pixel;
}

Rendering render(const PhaseCamera& device, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects) {
  check(device);
  PhaseCamera s = device;
  if (!effects.has(Effect::footprint)) s.sub_rays = 1;
  const DetectorEffects reading = detector_effects(effects);
  const int width = s.camera.width_px, height = s.camera.height_px;
  PhaseTaps frames{.calibration = {.camera = s.camera,
                                   .frequencies_hz = s.frequencies_hz,
                                   .sensor = delivered_sensor(s.sensor, reading),
                                   .max_range_m = s.max_range_m},
                   .taps = {}};
  const Image<std::uint16_t> blank(width, height);
  frames.taps.assign(s.frequencies_hz.size(), {blank, blank, blank, blank});
  const std::size_t pixels = blank.pixels.size();
  parallel_for(pixels, [&](std::size_t i) {
    const auto [column, row] = place_of(i, width);
    const PixelPhasors light = expected_phasors(s, caster, world_from_scanner, column, row);
    for (std::size_t f = 0; f < frames.taps.size(); ++f)
      for (int k = 0; k < 4; ++k) {
        const double mean = light.constant_e + modulation(light.amplitude_e[f], k);
        RandomStream random(address.seed, address.scan, (4 * f + k) * pixels + i);
        frames.taps[f][k].pixels[i] = read_pixel(s.sensor, reading, std::max(0.0, mean), random);
      }
  });
  return {.frames = std::move(frames), .statistics = {}};
}

std::vector<RayTruth> true_rays(const PhaseCamera& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner) {
  const int width = scanner.camera.width_px;
  std::vector<RayTruth> rays(static_cast<std::size_t>(width) * scanner.camera.height_px);
  parallel_for(rays.size(), [&](std::size_t i) {
    const auto [column, row] = place_of(i, width);
    const auto ray = pixel_ray(scanner, Eigen::Vector2d(column, row));
    if (ray) rays[i] = true_ray(caster, world_from_scanner, *ray);
  });
  return rays;
}

}  // namespace scan::synth
