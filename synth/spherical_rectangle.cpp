// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/spherical_rectangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan::synth {
namespace {

constexpr double least_solid_angle_sr = 1e-4;

// Interior angle between the planes through x and two neighbouring sides; a, b are the sides'
// distances across, z the plane's distance.
double corner_angle(double a, double b, double z) {
  return std::acos(std::clamp(a * b / (std::hypot(a, z) * std::hypot(b, z)), -1.0, 1.0));
}

}  // namespace

SphericalRectangle::SphericalRectangle(const Eigen::Vector2d& half_size_m,
                                       const Eigen::Vector3d& x_in_rectangle)
    : half_(half_size_m),
      low_(-half_size_m - x_in_rectangle.head<2>()),
      high_(half_size_m - x_in_rectangle.head<2>()),
      z_(-x_in_rectangle.z()) {
  b0_ = -low_.y() / std::hypot(low_.y(), z_);
  b1_ = high_.y() / std::hypot(high_.y(), z_);
  const double g0 = corner_angle(low_.y(), high_.x(), z_);
  const double g1 = corner_angle(-high_.x(), high_.y(), z_);
  const double g2 = corner_angle(high_.y(), low_.x(), z_);
  const double g3 = corner_angle(-low_.x(), low_.y(), z_);
  k_ = 2 * std::numbers::pi - g2 - g3;
  solid_angle_sr = g0 + g1 - k_;
  by_area_ = solid_angle_sr < least_solid_angle_sr;
}

Eigen::Vector2d SphericalRectangle::point(const Eigen::Vector2d& u) const {
  if (by_area_) return half_.cwiseProduct(2 * u - Eigen::Vector2d::Ones());
  // listing 2 of the paper: x such that the part of the rectangle left of it has the share u.x ...
  const double angle = u.x() * solid_angle_sr + k_;
  const double f = (std::cos(angle) * b0_ - b1_) / std::sin(angle);
  const double c = std::clamp(std::copysign(1 / std::hypot(f, b0_), f), -1.0, 1.0);
  const double x = std::clamp(-c * z_ / std::sqrt((1 - c) * (1 + c)), low_.x(), high_.x());
  // ... and y evenly by the sine of elevation on the line of that x
  const double across = std::hypot(x, z_);
  const double h0 = low_.y() / std::hypot(across, low_.y());
  const double h1 = high_.y() / std::hypot(across, high_.y());
  const double h = h0 + u.y() * (h1 - h0);
  const double y = std::clamp(h * across / std::sqrt((1 - h) * (1 + h)), low_.y(), high_.y());
  return {x - low_.x() - half_.x(), y - low_.y() - half_.y()};
}

double SphericalRectangle::density(const Eigen::Vector2d& point) const {
  if (!by_area_) return 1 / solid_angle_sr;
  const Eigen::Vector2d across = point + half_ + low_;
  const double distance = std::hypot(across.x(), across.y(), z_);
  const double area = 4 * half_.x() * half_.y();
  return distance * distance * distance / (-z_ * area);
}

}  // namespace scan::synth
