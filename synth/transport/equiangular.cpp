// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/equiangular.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace scan::synth {
namespace {

constexpr double least_beside_m = 1e-4;

}  // namespace

Brightest nearest_to(const Eigen::Vector3d& light, const Eigen::Vector3d& origin,
                     const Eigen::Vector3d& direction) {
  const double beside_m = direction.cross(light - origin).norm();
  return {direction.dot(light - origin), std::max(beside_m, least_beside_m)};
}

Equiangular::Equiangular(const Brightest& brightest, double end_m)
    : brightest_(brightest),
      begin_rad_(std::atan(-brightest.distance_m / brightest.half_width_m)),
      angle_rad_(std::atan((end_m - brightest.distance_m) / brightest.half_width_m) - begin_rad_) {}

double Equiangular::sample(double u) const {
  const double angle_rad = begin_rad_ + u * angle_rad_;
  return std::max(brightest_.distance_m + brightest_.half_width_m * std::tan(angle_rad), 0.0);
}

double Equiangular::density(double distance_m) const {
  const double w = brightest_.half_width_m, from_brightest_m = distance_m - brightest_.distance_m;
  return w / (angle_rad_ * (w * w + from_brightest_m * from_brightest_m));
}

}  // namespace scan::synth
