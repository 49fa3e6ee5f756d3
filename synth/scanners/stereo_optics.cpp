// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/stereo_optics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "libscan/core/random.h"
#include "synth/scanners/pixel_grid.h"

namespace scan::synth {
namespace {

constexpr double dot_radius = 0.3;       // of the cell's width
constexpr double dot_probability = 0.5;  // that a cell has a dot

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

// Point i of n spread evenly over the unit disk by the golden angle (Vogel 1979), turned by `turn`
// of a full circle.
Eigen::Vector2d on_disk(int i, int n, double turn) {
  const double angle = 2 * std::numbers::pi * (turn + i * (2 - std::numbers::phi));
  return std::sqrt((i + 0.5) / n) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

// Which point of lens or exposure goes with sub-ray i: a fixed shuffle, so that neither follows the
// place inside the pixel. 0.618 n steps on, made coprime with n.
int partner(int i, int n) {
  int stride = static_cast<int>(std::lround((std::numbers::phi - 1) * n));
  while (std::gcd(stride, n) != 1) ++stride;
  return static_cast<int>((static_cast<long>(i) * stride) % n);
}

// The ray from a point of the lens that meets the pinhole's ray in the plane of focus.
ScannerRay through_lens(const StereoPair& s, const Eigen::Vector3d& toward,
                        const Eigen::Vector2d& lens) {
  const Eigen::Vector3d origin(lens.x(), lens.y(), 0);
  return {.origin = origin, .direction = (s.focus_m * toward - origin).normalized()};
}

// cos^4 law of the image's illumination.
double vignetting_factor(const StereoPair& s, const Eigen::Vector3d& toward) {
  const double cosine2 = 1 / toward.squaredNorm();  // toward.z = 1
  return 1 - s.vignetting * (1 - cosine2 * cosine2);
}

// Towards a place of the image, z = 1, in the camera's frame.
Eigen::Vector3d toward(const StereoCalibration& c, StereoSide side, const Eigen::Vector2d& place) {
  const double cx = side == StereoSide::left ? c.cx_px : c.cx_px + c.doffs_px;
  return {(place.x() - cx) / c.focal_px, (place.y() - c.cy_px) / c.focal_px, 1};
}

Eigen::Matrix3d turned(const Eigen::Vector3d& vector_rad) {
  Vector6 twist = Vector6::Zero();
  twist.head<3>() = vector_rad;
  return exp(twist).linear();
}

}  // namespace

Pose scanner_from_camera(const StereoPair& s, StereoSide side) {
  if (side == StereoSide::left) return Pose::Identity();
  return make_pose(turned(s.right_rotation_error_rad),
                   Eigen::Vector3d(s.calibration.baseline_m, 0, 0) + s.right_position_error_m);
}

StereoPair with_effects(StereoPair s, const EffectSet& effects) {
  const auto off = [&](Effect effect) { return !effects.has(effect); };
  if (off(Effect::footprint)) s.sub_rays = 1;
  if (off(Effect::defocus)) s.aperture_m = 0;
  if (off(Effect::vignetting)) s.vignetting = 0;
  if (off(Effect::rolling_shutter)) s.row_time_s = 0;
  if (off(Effect::motion)) s.exposure_s = 0;
  if (off(Effect::miscalibration)) {
    s.right_rotation_error_rad.setZero();
    s.right_position_error_m.setZero();
  }
  return s;
}

bool has_effect(const StereoPair& s, Effect effect) {
  const bool moves = !s.velocity_m_s.isZero(0) || !s.angular_velocity_rad_s.isZero(0);
  switch (effect) {
    case Effect::footprint:
      return s.sub_rays > 1;
    case Effect::defocus:
      return s.aperture_m > 0;
    case Effect::vignetting:
      return s.vignetting > 0;
    case Effect::motion:
      return moves && s.exposure_s > 0;
    case Effect::rolling_shutter:
      return moves && s.row_time_s > 0;
    case Effect::miscalibration:
      return !s.right_rotation_error_rad.isZero(0) || !s.right_position_error_m.isZero(0);
    default:
      return false;
  }
}

ScannerRay calibrated_ray(const StereoCalibration& c, StereoSide side,
                          const Eigen::Vector2d& place) {
  const double x = side == StereoSide::left ? 0 : c.baseline_m;
  return {.origin = {x, 0, 0}, .direction = toward(c, side, place).normalized()};
}

StereoRay stereo_ray(const StereoPair& s, StereoSide side, const Eigen::Vector2d& place,
                     const Eigen::Vector2d& on_lens, int row, double instant) {
  const Eigen::Vector3d straight = toward(s.calibration, side, place);
  StereoRay result{.factor = vignetting_factor(s, straight)};
  result.time_s =
      s.row_time_s * (row - (s.calibration.height_px - 1) / 2.0) + s.exposure_s * (instant - 0.5);
  const ScannerRay ray = s.aperture_m > 0 ? through_lens(s, straight, s.aperture_m / 2 * on_lens)
                                          : ScannerRay{.direction = straight.normalized()};
  const Pose camera = scanner_from_camera(s, side);
  result.ray = {.origin = camera * ray.origin, .direction = camera.linear() * ray.direction};
  return result;
}

StereoRay stereo_ray(const StereoPair& s, StereoSide side, int column, int row, int i) {
  const int n = s.sub_rays * s.sub_rays;
  const Eigen::Vector2d place = sub_pixel({column, row}, i, s.sub_rays);
  Eigen::Vector2d on_lens = Eigen::Vector2d::Zero();
  if (s.aperture_m > 0) {
    // neighbours use other points of the lens, so that few of them leave noise and no pattern
    const double turn = philox4x32({static_cast<std::uint32_t>(column),
                                    static_cast<std::uint32_t>(row), side == StereoSide::right, 0},
                                   {0x6c656e73, 0})[0] *
                        0x1p-32;
    on_lens = on_disk(partner(i, n), n, turn);
  }
  return stereo_ray(s, side, place, on_lens, row, (partner(i, n) + 0.5) / n);
}

Pose moved(const StereoPair& s, double time_s) {
  return make_pose(turned(s.angular_velocity_rad_s * time_s), s.velocity_m_s * time_s);
}

bool is_moving(const StereoPair& s) {
  return (s.row_time_s != 0 || s.exposure_s != 0) &&
         (!s.velocity_m_s.isZero(0) || !s.angular_velocity_rad_s.isZero(0));
}

double blur_px(const StereoPair& s, double z_m) {
  return s.aperture_m * s.calibration.focal_px * std::abs(1 / z_m - 1 / s.focus_m);
}

double projector_electrons(const StereoPair& s, const Eigen::Vector3d& x_in_scanner) {
  if (s.projector_dots == 0 || s.projector_electrons == 0) return 0;
  const Eigen::Vector3d path = x_in_scanner - Eigen::Vector3d(s.calibration.baseline_m / 2, 0, 0);
  if (!(path.z() > 0)) return 0;
  const double cells = s.projector_dots * s.calibration.focal_px / s.calibration.width_px;
  const double pattern = dot_pattern(cells * path.x() / path.z(), cells * path.y() / path.z());
  return s.projector_electrons * pattern * s.focus_m * s.focus_m / path.squaredNorm();
}

}  // namespace scan::synth
