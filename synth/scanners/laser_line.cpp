// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line.h"

#include <cmath>
#include <numbers>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "synth/scanners/laser_line_optics.h"

namespace scan::synth {
namespace {

void require(bool fulfilled, const char* field, double value, const char* limit) {
  if (fulfilled) return;
  throw Error(Trouble::input,
              "laser_line/" + std::string(field) + " is " + std::to_string(value) + ", " + limit);
}

void require_positive(const char* field, double value) {
  require(std::isfinite(value) && value > 0, field, value, "must be positive");
}

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
  check(s.sensor);
  require_positive("baseline_m", s.baseline_m);
  require(s.triangulation_rad > 0 && s.triangulation_rad < std::numbers::pi / 2,
          "triangulation_rad", s.triangulation_rad, "must be between 0 and pi/2");
  require(s.fan_rad > 0 && s.fan_rad < std::numbers::pi, "fan_rad", s.fan_rad,
          "must be between 0 and pi");
  require_positive("beam_radius_m", s.beam_radius_m);
  require(std::isfinite(s.peak_electrons) && s.peak_electrons >= 0, "peak_electrons",
          s.peak_electrons, "must not be negative");
  require(s.steps >= 1, "steps", s.steps, "must be at least 1");
  require(std::isfinite(s.step_m), "step_m", s.step_m, "must be finite");
  require(std::isfinite(s.turn_rad), "turn_rad", s.turn_rad, "must be finite");
  require_positive("stage_direction/length", s.stage_direction.norm());
  require_positive("turn_axis/length", s.turn_axis.norm());
  require(s.turn_centre_m.allFinite(), "turn_centre_m", s.turn_centre_m.sum(), "must be finite");
  require(s.sub_rays >= 1 && s.sub_rays <= 64, "sub_rays", s.sub_rays, "must be from 1 to 64");
  require(s.min_range_m >= 0 && s.min_range_m < s.max_range_m, "min_range_m", s.min_range_m,
          "must not be negative nor reach max_range_m");
}

RawFrames render(const LaserLine& scanner, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const DetectorEffects& effects) {
  check(scanner);
  const LaserSheet sheet = laser_sheet(scanner);
  StripeImages frames;
  frames.calibration = {.camera = scanner.camera,
                        .plane_normal = sheet.normal,
                        .plane_offset_m = sheet.offset_m,
                        .sensor = delivered_sensor(scanner.sensor, effects),
                        .min_range_m = scanner.min_range_m,
                        .max_range_m = scanner.max_range_m};
  frames.scanner_from_camera = scanner_from_camera(scanner);
  frames.images.resize(scanner.steps);
  parallel_for(
      frames.images.size(),
      [&](std::size_t step) {
        const LaserView view{scanner, sheet, caster,
                             world_from_scanner * frames.scanner_from_camera[step]};
        frames.images[step] = render_step(view, static_cast<int>(step), address, effects);
      },
      1);
  return frames;
}

}  // namespace scan::synth
