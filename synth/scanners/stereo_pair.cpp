// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/stereo_pair.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"
#include "synth/scanners/first_surface.h"
#include "synth/scanners/limits.h"
#include "synth/scanners/pixel_grid.h"

namespace scan::synth {
namespace {

constexpr double dot_radius = 0.3;       // of the cell's width
constexpr double dot_probability = 0.5;  // that a cell has a dot

// The ray of a camera through a place in its image (pixels).
ScannerRay camera_ray(const StereoCalibration& c, StereoSide side, const Eigen::Vector2d& place) {
  const bool left = side == StereoSide::left;
  const double cx = left ? c.cx_px : c.cx_px + c.doffs_px;
  const Eigen::Vector3d toward((place.x() - cx) / c.focal_px, (place.y() - c.cy_px) / c.focal_px,
                               1);
  return {.origin = {left ? 0 : c.baseline_m, 0, 0}, .direction = toward.normalized()};
}

// Brightness, 0 to 1, of the projected pattern at a place measured in cells from the projector's
// axis.
double dot_pattern(double x_cells, double y_cells) {
  const double column = std::floor(x_cells), row = std::floor(y_cells);
  const auto word = [](double cell) {  // far outside the field cells repeat; nobody looks there
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::clamp(cell, -1e9, 1e9)));
  };
  const auto random = philox4x32({word(column), word(row), 0, 0}, {0x646f7473, 0});
  const auto uniform = [&](int i) { return random[i] * 0x1p-32; };
  if (uniform(0) >= dot_probability) return 0;
  const double free = 1 - 2 * dot_radius;  // the dot stays inside its cell
  const double dx = x_cells - column - dot_radius - free * uniform(1);
  const double dy = y_cells - row - dot_radius - free * uniform(2);
  const double inside = std::max(0.0, 1 - (dx * dx + dy * dy) / (dot_radius * dot_radius));
  return inside * inside;
}

// Electrons that the projector adds for a white surface.
double projector_light(const StereoPair& s, const RayCaster& caster, const Pose& world_from_scanner,
                       const SeenSurface& seen) {
  if (s.projector_dots == 0 || s.projector_electrons == 0) return 0;
  const Eigen::Vector3d projector(s.calibration.baseline_m / 2, 0, 0);
  const Eigen::Vector3d path = seen.point - projector;
  if (!(path.z() > 0)) return 0;
  const double cells = s.projector_dots * s.calibration.focal_px / s.calibration.width_px;
  const double pattern = dot_pattern(cells * path.x() / path.z(), cells * path.y() / path.z());
  const double cosine = -seen.normal.dot(path.normalized());
  if (pattern == 0 || !(cosine > 0)) return 0;
  if (caster.occluded(seen.hit, world_from_scanner * projector)) return 0;
  return s.projector_electrons * pattern * cosine * s.focus_m * s.focus_m / path.squaredNorm();
}

Image<std::uint8_t> render_side(const StereoPair& s, const RayCaster& caster,
                                const Pose& world_from_scanner, StereoSide side,
                                const RenderAddress& address, DetectorEffects effects) {
  effects.quantisation = true;  // the image has 8 bits
  Image<std::uint8_t> image(s.calibration.width_px, s.calibration.height_px);
  const std::uint64_t first = side == StereoSide::left ? 0 : image.pixels.size();
  parallel_for(image.pixels.size(), [&](std::size_t i) {
    const auto [column, row] = place_of(i, image.width);
    RandomStream random(address.seed, address.scan, first + i);
    const double mean = expected_electrons(s, caster, world_from_scanner, side, column, row);
    image.pixels[i] = static_cast<std::uint8_t>(read_pixel(s.sensor, effects, mean, random));
  });
  return image;
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
}

double expected_electrons(const StereoPair& s, const RayCaster& caster,
                          const Pose& world_from_scanner, StereoSide side, int column, int row) {
  double sum = 0;
  for (int i = 0; i < s.sub_rays * s.sub_rays; ++i) {
    const Eigen::Vector2d place = sub_pixel({column, row}, i, s.sub_rays);
    const ScannerRay ray = camera_ray(s.calibration, side, place);
    const auto seen = first_surface(caster, world_from_scanner, ray);
    if (!seen) continue;
    const double albedo = albedo_at(caster.scene(), seen->hit.object, seen->hit.point);
    sum += albedo * (s.ambient_electrons + projector_light(s, caster, world_from_scanner, *seen));
  }
  return sum / (s.sub_rays * s.sub_rays);
}

Rendering render(const StereoPair& device, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects) {
  check(device);
  StereoPair scanner = device;
  if (!effects.has(Effect::footprint)) scanner.sub_rays = 1;
  const auto side = [&](StereoSide which) {
    return render_side(scanner, caster, world_from_scanner, which, address,
                       detector_effects(effects));
  };
  return {.frames = ImagePair{.calibration = scanner.calibration,
                              .left = side(StereoSide::left),
                              .right = side(StereoSide::right)},
          .statistics = {}};
}

std::vector<RayTruth> true_rays(const StereoPair& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner) {
  const StereoCalibration& c = scanner.calibration;
  std::vector<RayTruth> rays(static_cast<std::size_t>(c.width_px) * c.height_px);
  parallel_for(rays.size(), [&](std::size_t i) {
    const auto [column, row] = place_of(i, c.width_px);
    rays[i] = true_ray(caster, world_from_scanner,
                       camera_ray(c, StereoSide::left, Eigen::Vector2d(column, row)));
  });
  return rays;
}

}  // namespace scan::synth
