// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line.h"

#include <numbers>

#include "libscan/core/parallel.h"
#include "synth/scanners/laser_line_optics.h"
#include "synth/scanners/limits.h"

namespace scan::synth {
namespace {

// Mean over sub_rays x sub_rays places in the pixel.
double pixel_electrons(const LaserView& view, int column, int row) {
  const int n = view.scanner.sub_rays;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Eigen::Vector2d place(column + (j + 0.5) / n - 0.5, row + (i + 0.5) / n - 0.5);
      if (const auto ray = ray_through(view.scanner.camera, place)) sum += view.electrons(*ray);
    }
  return sum / (n * n);
}

Image<std::uint16_t> render_step(const LaserView& view, int step, const RenderAddress& address,
                                 const DetectorEffects& effects) {
  const Camera& camera = view.scanner.camera;
  const Image<std::uint8_t> band = lit_band(view);
  Image<std::uint16_t> image(camera.width_px, camera.height_px);
  parallel_for(
      static_cast<std::size_t>(camera.height_px),
      [&](std::size_t r) {
        const int row = static_cast<int>(r);
        RandomStream random(address.seed, address.scan,
                            static_cast<std::uint64_t>(step) * camera.height_px + r);
        for (int column = 0; column < camera.width_px; ++column) {
          const double expected_e = band(column, row) ? pixel_electrons(view, column, row) : 0;
          image(column, row) = read_pixel(view.scanner.sensor, effects, expected_e, random);
        }
      },
      16);
  return image;
}

}  // namespace

void check(const LaserLine& s) {
  check(s.camera);
  require_sensor("laser_line", s.sensor, 16);
  const double right_angle_rad = std::numbers::pi / 2;
  require_positive("laser_line/baseline_m", s.baseline_m);
  require_within("laser_line/triangulation_rad", s.triangulation_rad, 1e-6, right_angle_rad - 1e-6);
  require_within("laser_line/fan_rad", s.fan_rad, 1e-6, 2 * right_angle_rad - 1e-6);
  require_positive("laser_line/beam_radius_m", s.beam_radius_m);
  require_within("laser_line/peak_electrons", s.peak_electrons, 0, 1e12);
  require_within("laser_line/steps", s.steps, 1, 1e6);
  require_finite("laser_line/step_m", s.step_m);
  require_finite("laser_line/turn_rad", s.turn_rad);
  require_positive("laser_line/stage_direction/length", s.stage_direction.norm());
  require_positive("laser_line/turn_axis/length", s.turn_axis.norm());
  require_finite("laser_line/turn_centre_m/distance", s.turn_centre_m.norm());
  require_within("laser_line/sub_rays", s.sub_rays, 1, 64);
  require_within("laser_line/min_range_m", s.min_range_m, 0, s.max_range_m);
  require_positive("laser_line/max_range_m", s.max_range_m);
  require_size("laser_line/images", 1.0 * s.steps * s.camera.width_px * s.camera.height_px);
}

Rendering render(const LaserLine& device, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects) {
  check(device);
  LaserLine scanner = device;
  if (!effects.has(Effect::footprint)) scanner.sub_rays = 1;
  const DetectorEffects reading = detector_effects(effects);
  const LaserSheet sheet = laser_sheet(scanner);
  StripeImages frames;
  frames.calibration = {.camera = scanner.camera,
                        .plane_normal = sheet.normal,
                        .plane_offset_m = sheet.offset_m,
                        .sensor = delivered_sensor(scanner.sensor, reading),
                        .min_range_m = scanner.min_range_m,
                        .max_range_m = scanner.max_range_m};
  frames.scanner_from_camera = scanner_from_camera(scanner);
  frames.images.resize(scanner.steps);
  parallel_for(
      frames.images.size(),
      [&](std::size_t step) {
        const LaserView view{scanner, sheet, caster,
                             world_from_scanner * frames.scanner_from_camera[step]};
        frames.images[step] = render_step(view, static_cast<int>(step), address, reading);
      },
      1);
  return {.frames = std::move(frames), .statistics = {}};
}

}  // namespace scan::synth
