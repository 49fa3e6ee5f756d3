// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What became of each ray, and the scan that follows.
#pragma once

#include <span>
#include <string_view>

#include "libscan/core/scan.h"

namespace scan::decoding {

// Either `miss` names why there is no point, or it is empty and the rest holds.
struct RayOutcome {
  std::string_view miss = {};
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       // scanner frame, m
  double sigma_m = 0;                                    // along the viewing ray
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m^2
  double intensity = 0;
};

inline RayOutcome missed(std::string_view reason) {
  return {.miss = reason};
}

// Points in the order of their rays; one count per reason: points + misses = outcomes.
Scan collect(std::span<const RayOutcome> outcomes, RayGrid grid);

// The outcome of a distance measured along an exact ray: covariance of rank one along the ray.
RayOutcome point_on_ray(const Eigen::Vector3d& unit_direction, double range_m, double sigma_m,
                        double intensity);

}  // namespace scan::decoding
