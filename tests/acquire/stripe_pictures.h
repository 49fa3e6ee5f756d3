// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A laser's stripe on boards and walls as a camera would see it.
#pragma once

#include <optional>

#include "libscan/core/raw_frames.h"
#include "tests/acquire/board_pictures.h"

namespace scan::test {

// From a laser 0.12 m to the right of the camera to a place 0.3 m before it.
inline const Eigen::Vector3d true_normal = Eigen::Vector3d(0.3, 0.01, 0.12).normalized();
inline const double true_offset_m = true_normal.dot(Eigen::Vector3d(0, 0, 0.3));

inline const Sensor sensor{
    .gain_e_per_dn = 4, .read_noise_e = 10, .full_well_e = 16000, .bits = 12};

// Boards near the light plane, at three distances, tilted.
inline std::vector<Pose> boards_in_light() {
  std::vector<Pose> poses;
  for (int i = 0; i < 6; ++i) {
    const double z_m = 0.24 + 0.03 * (i % 4);
    const double x_m = (true_offset_m - true_normal.z() * z_m) / true_normal.x();
    const Camera camera = bent_camera();
    poses.push_back(
        held_board(camera, test_board, {395 + 900 * x_m / z_m, 305}, z_m, 0.3 + 0.05 * i, 1.0 * i));
  }
  return poses;
}

// Distance from the light plane of the place that a pixel sees on a plane normal . x = offset.
inline double off_plane_m(const Eigen::Vector2d& pixel, const Eigen::Vector3d& normal,
                          double offset_m) {
  const Eigen::Vector3d ray = ray_through(bent_camera(), pixel).value();
  return true_normal.dot(ray * (offset_m / normal.dot(ray))) - true_offset_m;
}

// The column at which a row sees the stripe on a board, by bisection; none outside the picture.
inline std::optional<double> stripe_column(const Pose& pose, int row) {
  const Eigen::Vector3d normal = pose.linear().col(2);
  const double offset_m = normal.dot(pose.translation());
  double low = 0, high = bent_camera().width_px - 1;
  const auto off = [&](double column) {
    return off_plane_m({column, static_cast<double>(row)}, normal, offset_m);
  };
  if (off(low) * off(high) > 0) return std::nullopt;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (off(low) * off(middle) > 0 ? low : high) = middle;
  }
  return low;
}

// The laser's Gaussian light, 0.2 mm of sigma, on a plane of the given brightness.
template <class Reflectance>
Image<std::uint16_t> stripe_picture(const Pose& pose, Reflectance&& reflectance,
                                    std::uint64_t seed) {
  const Camera camera = bent_camera();
  const Eigen::Vector3d normal = pose.linear().col(2);
  const double offset_m = normal.dot(pose.translation());
  const Pose board_from_camera = pose.inverse();
  Image<std::uint16_t> picture(camera.width_px, camera.height_px);
  RandomStream random(seed, 2, 0);
  for (int row = 0; row < camera.height_px; ++row)
    for (int column = 0; column < camera.width_px; ++column) {
      const Eigen::Vector2d pixel(column, row);
      const double off = off_plane_m(pixel, normal, offset_m) / 2e-4;
      double expected_e = 0;
      if (std::abs(off) < 8) {
        const Eigen::Vector2d at = on_board(camera, board_from_camera, pixel);
        expected_e = 12000 * reflectance(at) * std::exp(-off * off / 2);
      }
      const double noise_e = sensor.read_noise_e * random.normal();
      const double electrons = static_cast<double>(random.poisson(expected_e)) + noise_e;
      picture(column, row) =
          static_cast<std::uint16_t>(std::clamp(std::round(electrons / 4), 0.0, 4000.0));
    }
  return picture;
}

}  // namespace scan::test
