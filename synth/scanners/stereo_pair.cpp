// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/stereo_pair.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"
#include "synth/scanners/first_surface.h"
#include "synth/scanners/limits.h"
#include "synth/scanners/pixel_grid.h"
#include "synth/scanners/stereo_optics.h"
#include "synth/scanners/stereo_paths.h"
#include "synth/scanners/surface_frame.h"

namespace scan::synth {
namespace {

// Electrons that a ray brings: of ambient light, and of the projector where it is not in shadow.
double ray_electrons(const StereoPair& s, const RayCaster& caster, const Pose& world_from_scanner,
                     const SeenSurface& seen, const ScannerRay& ray) {
  const SurfaceFrame surface(seen, caster.scene());
  const Eigen::Vector3d out = -ray.direction;
  double sum = s.ambient_electrons * surface.albedo(out);
  const Eigen::Vector3d projector(s.calibration.baseline_m / 2, 0, 0);
  const double light_e = projector_electrons(s, seen.point);
  if (light_e == 0) return sum;
  const Eigen::Vector3d in = (projector - seen.point).normalized();
  if (!(seen.normal.dot(in) > 0)) return sum;
  if (caster.occluded(seen.hit, world_from_scanner * projector)) return sum;
  return sum + light_e * surface.response(out, in);
}

// Reads every pixel; `mean(pixel, column, row)` is its mean electrons.
template <class Mean>
Image<std::uint8_t> read_side(const StereoPair& s, StereoSide side, const RenderAddress& address,
                              DetectorEffects effects, const Mean& mean) {
  effects.quantisation = true;  // the image has 8 bits
  Image<std::uint8_t> image(s.calibration.width_px, s.calibration.height_px);
  const std::uint64_t first = side == StereoSide::left ? 0 : image.pixels.size();
  parallel_for(image.pixels.size(), [&](std::size_t i) {
    const auto [column, row] = place_of(i, image.width);
    RandomStream random(address.seed, address.scan, first + i);
    image.pixels[i] =
        static_cast<std::uint8_t>(read_pixel(s.sensor, effects, mean(i, column, row), random));
  });
  return image;
}

Rendering render_direct(const StereoPair& s, const RayCaster& caster, const Pose& pose,
                        const RenderAddress& address, const DetectorEffects& reading) {
  const auto side = [&](StereoSide which) {
    return read_side(s, which, address, reading, [&](std::size_t, int column, int row) {
      return expected_electrons(s, caster, pose, which, column, row);
    });
  };
  return {.frames = ImagePair{.calibration = s.calibration,
                              .left = side(StereoSide::left),
                              .right = side(StereoSide::right)},
          .statistics = {}};
}

Rendering render_paths(const StereoPair& s, const LightTransport& transport, const Pose& pose,
                       const RenderAddress& address, const DetectorEffects& reading) {
  const std::size_t pixels = static_cast<std::size_t>(s.calibration.width_px) *
                             static_cast<std::size_t>(s.calibration.height_px);
  std::vector<ReadingError> errors(2 * pixels);
  const auto side = [&](StereoSide which) {
    const std::size_t first = which == StereoSide::left ? 0 : pixels;
    return read_side(s, which, address, reading, [&](std::size_t i, int column, int row) {
      const PixelEstimate pixel = path_electrons(s, transport, pose, address, which, column, row);
      errors[first + i] = {pixel.paths, pixel.standard_error / reading_noise_e(s, pixel.electrons)};
      return std::max(0.0, pixel.electrons);
    });
  };
  Image<std::uint8_t> left = side(StereoSide::left), right = side(StereoSide::right);
  return {.frames =
              ImagePair{
                  .calibration = s.calibration, .left = std::move(left), .right = std::move(right)},
          .statistics = statistics_of(errors)};
}

}  // namespace

void check(const StereoPair& s) {
  const StereoCalibration& c = s.calibration;
  require_positive("stereo_pair/calibration.width_px", c.width_px);
  require_positive("stereo_pair/calibration.height_px", c.height_px);
  require_size("stereo_pair/calibration.width_px * height_px", 1.0 * c.width_px * c.height_px);
  require_positive("stereo_pair/calibration.focal_px", c.focal_px);
  require_finite("stereo_pair/calibration.cx_px", c.cx_px);
  require_finite("stereo_pair/calibration.cy_px", c.cy_px);
  require_finite("stereo_pair/calibration.doffs_px", c.doffs_px);
  require_positive("stereo_pair/calibration.baseline_m", c.baseline_m);
  require_positive("stereo_pair/calibration.disparities_px", c.disparities_px);
  require_within("stereo_pair/ambient_electrons", s.ambient_electrons, 0, 1e9);
  require_within("stereo_pair/projector_electrons", s.projector_electrons, 0, 1e9);
  require_within("stereo_pair/projector_dots", s.projector_dots, 0, 1e6);
  require_positive("stereo_pair/focus_m", s.focus_m);
  require_within("stereo_pair/sub_rays", s.sub_rays, 1, 64);
  require_sensor("stereo_pair", s.sensor, 8);
  require_positive("stereo_pair/wavelength_m", s.wavelength_m);
  require_within("stereo_pair/electrons_per_w_m2", s.electrons_per_w_m2, 0, 1e12);
  require_within("stereo_pair/aperture_m", s.aperture_m, 0, 1);
  require_within("stereo_pair/vignetting", s.vignetting, 0, 1);
  require_finite("stereo_pair/right_rotation_error_rad", s.right_rotation_error_rad.norm());
  require_finite("stereo_pair/right_position_error_m", s.right_position_error_m.norm());
  require_finite("stereo_pair/velocity_m_s", s.velocity_m_s.norm());
  require_finite("stereo_pair/angular_velocity_rad_s", s.angular_velocity_rad_s.norm());
  require_within("stereo_pair/row_time_s", s.row_time_s, 0, 1);
  require_within("stereo_pair/exposure_s", s.exposure_s, 0, 10);
}

double expected_electrons(const StereoPair& s, const RayCaster& caster,
                          const Pose& world_from_scanner, StereoSide side, int column, int row) {
  const bool moving = is_moving(s);
  double sum = 0;
  for (int i = 0; i < s.sub_rays * s.sub_rays; ++i) {
    const StereoRay stereo = stereo_ray(s, side, column, row, i);
    const Pose world_from_moved =
        moving ? world_from_scanner * moved(s, stereo.time_s) : world_from_scanner;
    if (const auto seen = first_surface(caster, world_from_moved, stereo.ray))
      sum += stereo.factor * ray_electrons(s, caster, world_from_moved, *seen, stereo.ray);
  }
  return sum / (s.sub_rays * s.sub_rays);
}

Rendering render(const StereoPair& device, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects) {
  check(device);
  const StereoPair scanner = with_effects(device, effects);
  const DetectorEffects reading = detector_effects(effects);
  if (!needs_paths(caster.scene(), effects))
    return render_direct(scanner, caster, world_from_scanner, address, reading);
  const LightTransport transport(caster, transport_options(effects, false));
  return render_paths(scanner, transport, world_from_scanner, address, reading);
}

std::vector<RayTruth> true_rays(const StereoPair& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner) {
  const StereoCalibration& c = scanner.calibration;
  std::vector<RayTruth> rays(static_cast<std::size_t>(c.width_px) * c.height_px);
  parallel_for(rays.size(), [&](std::size_t i) {
    const auto [column, row] = place_of(i, c.width_px);
    rays[i] = true_ray(caster, world_from_scanner,
                       calibrated_ray(c, StereoSide::left, Eigen::Vector2d(column, row)));
  });
  return rays;
}

}  // namespace scan::synth
