// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "synth/scanners/laser_line_blooming.h"
#include "synth/scanners/laser_line_exposure.h"
#include "synth/scanners/limits.h"
#include "synth/scanners/row_reader.h"

namespace scan::synth {
namespace {

// A step's expected light: direct, and where paths add to it.
struct StepLight {
  Image<std::uint8_t> lit;
  Image<std::uint8_t> brightened;  // empty without paths
  Image<double> laser_e, other_e;
};

StepLight direct_light(const LaserExposure& exposure) {
  const LaserPaths* paths = exposure.sweep().paths;
  StepLight light{.lit = exposure.lit()};
  light.laser_e = light.other_e = Image<double>(light.lit.width, light.lit.height);
  if (paths && !paths->direct_is_straight) return light;
  parallel_for(
      static_cast<std::size_t>(light.lit.height),
      [&](std::size_t r) {
        const int row = static_cast<int>(r);
        for (int column = 0; column < light.lit.width; ++column) {
          if (!light.lit(column, row)) continue;
          const PixelLight pixel = exposure.direct(column, row);
          light.laser_e(column, row) = pixel.laser_e;
          light.other_e(column, row) = pixel.other_e;
        }
      },
      16);
  return light;
}

// Expected electrons of a row, all effects of light included.
std::vector<double> row_light(const LaserExposure& exposure, const StepLight& light, int row,
                              PathTally& tally) {
  const LaserSweep& sweep = exposure.sweep();
  const int width = light.lit.width;
  const bool all_by_paths = sweep.paths && !sweep.paths->direct_is_straight;
  std::vector<double> row_e(width, 0), other_e(width, 0);
  int first = width, end = 0;
  for (int column = 0; column < width; ++column) {
    const bool is_lit = light.lit(column, row);
    const bool by_paths =
        sweep.paths && (light.brightened(column, row) || (is_lit && all_by_paths));
    if (!is_lit && !by_paths) continue;
    first = std::min(first, column);
    end = column + 1;
    PixelLight pixel{light.laser_e(column, row), light.other_e(column, row)};
    if (by_paths) {
      const PixelLight more = exposure.by_paths(column, row, pixel, tally);
      pixel.laser_e += more.laser_e;
      pixel.other_e += more.other_e;
    }
    row_e[column] = pixel.laser_e;
    other_e[column] = pixel.other_e;
  }
  if (sweep.speckle.contrast > 0 && first < end)
    mottle(sweep.speckle, sweep.address, exposure.step(), row, first,
           std::span(row_e).subspan(first, end - first));
  for (int column = first; column < end; ++column) row_e[column] += other_e[column];
  return row_e;
}

// Charge before numbers: its shot noise comes first, then what full pixels spill.
void spill(const LaserSweep& sweep, std::span<double> row_e, RandomStream& random) {
  if (sweep.detector.shot_noise)
    for (double& e : row_e) e = static_cast<double>(random.poisson(e));
  bloom(row_e, sweep.scanner.sensor.full_well_e, sweep.scanner.blooming_share);
}

Image<std::uint16_t> render_step(const LaserExposure& exposure, const RowReader& reader,
                                 PathTally& tally) {
  const LaserSweep& sweep = exposure.sweep();
  const Camera& camera = sweep.scanner.camera;
  const bool blooms = sweep.scanner.blooming_share > 0;
  StepLight light = direct_light(exposure);
  if (sweep.paths) light.brightened = exposure.brightened(light.lit, light.laser_e, tally);
  Image<std::uint16_t> image(camera.width_px, camera.height_px);
  std::vector<PathTally> tallies(camera.height_px);
  parallel_for(
      static_cast<std::size_t>(camera.height_px),
      [&](std::size_t r) {
        const int row = static_cast<int>(r);
        const std::uint64_t ray =
            static_cast<std::uint64_t>(exposure.step()) * camera.height_px + r;
        RandomStream random(sweep.address.seed, sweep.address.scan, ray);
        std::vector<double> row_e = row_light(exposure, light, row, tallies[r]);
        if (blooms) spill(sweep, row_e, random);
        RowReader::Memory memory;
        reader.read(sweep.address, ray, row_e, std::span(&image(0, row), row_e.size()), memory);
      },
      16);
  for (const PathTally& each : tallies) tally += each;
  return image;
}

LaserLineCalibration calibration_of(const LaserLine& device, const DetectorEffects& reading) {
  const LaserSheet plane = laser_sheet(with_effects(device, {}));
  return {.camera = device.camera,
          .plane_normal = plane.normal,
          .plane_offset_m = plane.offset_m,
          .sensor = delivered_sensor(device.sensor, reading),
          .min_range_m = device.min_range_m,
          .max_range_m = device.max_range_m};
}

void check_imperfections(const LaserLine& s) {
  require_positive("laser_line/wavelength_m", s.wavelength_m);
  require_within("laser_line/wavelength_m", s.wavelength_m, 0, 1e-3);
  if (s.beam_quality != 0) require_within("laser_line/beam_quality", s.beam_quality, 1, 1e6);
  require_finite("laser_line/plane_bow_m", s.plane_bow_m);
  require_finite("laser_line/plane_shift_m", s.plane_shift_m);
  const double right_angle_rad = std::numbers::pi / 2;
  require_within("laser_line/triangulation_rad plus plane_turn_rad",
                 s.triangulation_rad + s.plane_turn_rad, 1e-6, right_angle_rad - 1e-6);
  require_within("laser_line/aperture_m", s.aperture_m, 0, 1);
  require_within("laser_line/lens_focus_m", s.lens_focus_m, 0, 1e9);
  require_within("laser_line/speckle_contrast", s.speckle_contrast, 0, 1);
  if (s.speckle_contrast > 0) {
    require_within("laser_line/speckle_contrast", s.speckle_contrast, 0.01, 1);
    require_positive("laser_line/aperture_m", s.aperture_m);
  }
  require_within("laser_line/exposure_share", s.exposure_share, 0, 1);
  require_within("laser_line/blooming_share", s.blooming_share, 0, 1);
  require_within("laser_line/ambient_electrons", s.ambient_electrons, 0, 1e12);
  require_within("laser_line/electrons_per_w_m2", s.electrons_per_w_m2, 0, 1e15);
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
  check_imperfections(s);
}

Rendering render(const LaserLine& device, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects) {
  check(device);
  const LaserLine scanner = with_effects(device, effects);
  std::optional<LaserPaths> paths;
  if (needs_paths(scanner, caster.scene(), effects)) paths.emplace(caster, effects);
  const LaserSweep sweep{.scanner = scanner,
                         .sheet = laser_sheet(scanner),
                         .samples = camera_samples(scanner),
                         .speckle = effects.has(Effect::speckle) ? speckle_of(device) : Speckle{},
                         .address = address,
                         .detector = detector_effects(effects),
                         .paths = paths ? &*paths : nullptr};
  DetectorEffects reading = sweep.detector;
  if (scanner.blooming_share > 0) reading.shot_noise = false;  // it comes before the charge spills
  const RowReader reader(scanner.sensor, reading);
  StripeImages frames;
  frames.calibration = calibration_of(device, sweep.detector);
  frames.scanner_from_camera = scanner_from_camera(scanner);
  frames.images.resize(scanner.steps);
  std::vector<PathTally> tallies(scanner.steps);
  parallel_for(
      frames.images.size(),
      [&](std::size_t step) {
        const LaserView view{scanner, sweep.sheet, caster,
                             world_from_scanner * frames.scanner_from_camera[step]};
        const LaserExposure exposure(sweep, view, static_cast<int>(step));
        frames.images[step] = render_step(exposure, reader, tallies[step]);
      },
      1);
  PathTally tally;
  for (const PathTally& each : tallies) tally += each;
  return {.frames = std::move(frames), .statistics = statistics_of(tally)};
}

}  // namespace scan::synth
