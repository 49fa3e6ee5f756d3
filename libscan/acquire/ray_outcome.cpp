// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/ray_outcome.h"

namespace scan::decoding {

Scan collect(std::span<const RayOutcome> outcomes, RayGrid grid) {
  Scan scan;
  scan.grid = grid;
  for (std::size_t ray = 0; ray < outcomes.size(); ++ray) {
    const RayOutcome& outcome = outcomes[ray];
    if (!outcome.miss.empty()) {
      ++scan.misses[std::string(outcome.miss)];
      continue;
    }
    scan.ray.push_back(static_cast<std::uint32_t>(ray));
    scan.cloud.points.push_back(outcome.point);
    scan.cloud.sigma_m.push_back(outcome.sigma_m);
    scan.cloud.covariances.push_back(outcome.covariance);
    scan.cloud.intensity.push_back(outcome.intensity);
  }
  return scan;
}

RayOutcome point_on_ray(const Eigen::Vector3d& unit_direction, double range_m, double sigma_m,
                        double intensity) {
  RayOutcome outcome;
  outcome.point = range_m * unit_direction;
  outcome.sigma_m = sigma_m;
  outcome.covariance = (sigma_m * sigma_m) * unit_direction * unit_direction.transpose();
  outcome.intensity = intensity;
  return outcome;
}

}  // namespace scan::decoding
