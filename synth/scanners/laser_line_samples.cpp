// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line_samples.h"

#include <cmath>
#include <numbers>

namespace scan::synth {
namespace {

std::vector<CameraSample> grid(int n) {
  std::vector<CameraSample> samples;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      samples.push_back({.place_px = {(j + 0.5) / n - 0.5, (i + 0.5) / n - 0.5}});
  return samples;
}

int next_prime(int n) {
  const auto is_prime = [](int p) {
    for (int d = 2; d * d <= p; ++d)
      if (p % d == 0) return false;
    return true;
  };
  while (!is_prime(n)) ++n;
  return n;
}

// From [-1, 1]^2 to the unit disk, areas in proportion and odd (Shirley and Chiu 1997).
Eigen::Vector2d on_disk(const Eigen::Vector2d& u) {
  if (u.isZero()) return u;
  const bool is_flat = std::abs(u.x()) > std::abs(u.y());
  const double radius = is_flat ? u.x() : u.y();
  const double quarter = std::numbers::pi / 4;
  const double angle = is_flat ? quarter * u.y() / u.x() : 2 * quarter - quarter * u.x() / u.y();
  return radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

std::vector<CameraSample> orthogonal_array(const LaserLine& scanner, int n) {
  // Level of a column of the array, and within it the level of another: in (-1, 1).
  const auto value = [n](int level, int sub_level) {
    return 2 * (level % n + (sub_level % n + 0.5) / n) / n - 1;
  };
  std::vector<CameraSample> samples;
  // i and j are centred, so that each column changes sign with them: (n - 1) / 2 is its middle.
  const int half = (n - 1) / 2;
  for (int i = -half; i <= half; ++i)
    for (int j = -half; j <= half; ++j) {
      const auto column = [&](int a, int b) { return a * i + b * j + half + 8 * n * n; };
      CameraSample sample;
      if (scanner.sub_rays > 1) sample.place_px = Eigen::Vector2d(j, i) / n;
      const Eigen::Vector2d lens(value(column(1, 1), column(0, 1)),
                                 value(column(1, 2), column(1, 0)));
      sample.lens_m = scanner.aperture_m / 2 * on_disk(lens);
      sample.time_steps = scanner.exposure_share / 2 * value(column(1, 3), column(1, 4));
      samples.push_back(sample);
    }
  return samples;
}

}  // namespace

double lens_focus_m(const LaserLine& scanner) {
  if (scanner.lens_focus_m > 0) return scanner.lens_focus_m;
  return scanner.baseline_m / std::tan(scanner.triangulation_rad);
}

double blur_radius_px(const LaserLine& scanner, double depth_m) {
  const double focal_px = std::max(scanner.camera.fx_px, scanner.camera.fy_px);
  return focal_px * scanner.aperture_m / 2 * std::abs(1 / depth_m - 1 / lens_focus_m(scanner));
}

std::vector<CameraSample> camera_samples(const LaserLine& scanner) {
  if (scanner.aperture_m == 0 && scanner.exposure_share == 0) return grid(scanner.sub_rays);
  return orthogonal_array(scanner, next_prime(std::max(5, scanner.sub_rays)));
}

std::optional<CameraRay> camera_ray(const LaserLine& scanner, const Eigen::Vector2d& pixel,
                                    const CameraSample& sample) {
  const auto ray = ray_through(scanner.camera, pixel + sample.place_px);
  if (!ray) return std::nullopt;
  if (scanner.aperture_m == 0) return CameraRay{Eigen::Vector3d::Zero(), ray->normalized()};
  const Eigen::Vector3d lens(sample.lens_m.x(), sample.lens_m.y(), 0);
  return CameraRay{lens, (lens_focus_m(scanner) * *ray - lens).normalized()};
}

}  // namespace scan::synth
