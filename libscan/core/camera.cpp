// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/camera.h"

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "libscan/core/error.h"

namespace scan {
namespace {

// Distorted normalised coordinates and their 2x2 derivative.
Eigen::Vector2d distort(const Camera& c, const Eigen::Vector2d& u, Eigen::Matrix2d& jacobian) {
  const double x = u.x(), y = u.y(), r2 = u.squaredNorm();
  const double radial = 1 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double slope = c.k1 + r2 * (2 * c.k2 + r2 * 3 * c.k3);  // d radial / d r2
  jacobian << radial + 2 * x * x * slope + 2 * c.p1 * y + 6 * c.p2 * x,
      2 * x * y * slope + 2 * c.p1 * x + 2 * c.p2 * y,
      2 * x * y * slope + 2 * c.p2 * y + 2 * c.p1 * x,
      radial + 2 * y * y * slope + 6 * c.p1 * y + 2 * c.p2 * x;
  return {x * radial + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x),
          y * radial + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y};
}

bool is_distorted(const Camera& c) {
  return c.k1 != 0 || c.k2 != 0 || c.k3 != 0 || c.p1 != 0 || c.p2 != 0;
}

void check_field(const char* name, double value, bool positive) {
  if (std::isfinite(value) && (!positive || value > 0)) return;
  throw Error(Trouble::input, std::string("camera: ") + name + " is " + std::to_string(value) +
                                  ", must be " + (positive ? "positive" : "finite"));
}

}  // namespace

void check(const Camera& c) {
  check_field("width_px", c.width_px, true);
  check_field("height_px", c.height_px, true);
  check_field("fx_px", c.fx_px, true);
  check_field("fy_px", c.fy_px, true);
  check_field("cx_px", c.cx_px, false);
  check_field("cy_px", c.cy_px, false);
  check_field("k1", c.k1, false);
  check_field("k2", c.k2, false);
  check_field("p1", c.p1, false);
  check_field("p2", c.p2, false);
  check_field("k3", c.k3, false);
}

std::optional<Eigen::Vector2d> project(const Camera& camera, const Eigen::Vector3d& x) {
  if (!(x.z() > 0)) return std::nullopt;
  Eigen::Matrix2d unused;
  const Eigen::Vector2d d = distort(camera, x.head<2>() / x.z(), unused);
  return Eigen::Vector2d(camera.fx_px * d.x() + camera.cx_px, camera.fy_px * d.y() + camera.cy_px);
}

std::optional<Eigen::Vector3d> ray_through(const Camera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d wanted((pixel.x() - camera.cx_px) / camera.fx_px,
                               (pixel.y() - camera.cy_px) / camera.fy_px);
  if (!is_distorted(camera)) return Eigen::Vector3d(wanted.x(), wanted.y(), 1);
  Eigen::Vector2d u = wanted;
  for (int iteration = 0; iteration < 30; ++iteration) {
    Eigen::Matrix2d jacobian;
    const Eigen::Vector2d error = distort(camera, u, jacobian) - wanted;
    if (error.norm() < 1e-14 * (1 + wanted.norm())) return Eigen::Vector3d(u.x(), u.y(), 1);
    const double determinant = jacobian.determinant();
    if (!(determinant > 0)) return std::nullopt;  // beyond the fold of the distortion
    u -= jacobian.inverse() * error;
  }
  Eigen::Matrix2d jacobian;
  const bool found = (distort(camera, u, jacobian) - wanted).norm() < 1e-12 * (1 + wanted.norm());
  if (!found) return std::nullopt;
  return Eigen::Vector3d(u.x(), u.y(), 1);
}

}  // namespace scan
