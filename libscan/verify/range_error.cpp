// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Errors along the rays of one scan, and whether the scan's own sigma is honest.
#include <cmath>
#include <map>
#include <string>

#include "libscan/core/error.h"
#include "libscan/verify/stated_uncertainty.h"
#include "libscan/verify/statistics.h"
#include "libscan/verify/surface_error.h"

namespace scan {
namespace {

void check_input(const PointCloud& cloud, std::span<const std::uint32_t> ray,
                 const ScanTruth& truth) {
  check(cloud);
  if (ray.size() != cloud.size())
    throw Error(Trouble::input, "range error: scan " + truth.name + " has " +
                                    std::to_string(cloud.size()) + " points and " +
                                    std::to_string(ray.size()) + " ray numbers");
  for (const std::uint32_t r : ray)
    if (r >= truth.rays.size())
      throw Error(Trouble::input, "range error: scan " + truth.name + " names ray " +
                                      std::to_string(r) + ", its truth has " +
                                      std::to_string(truth.rays.size()));
}

// Ray -> its nearest finite point: later returns of a pulse come from behind the first surface, and
// the truth knows only that one.
std::map<std::uint32_t, std::size_t> first_returns(const PointCloud& cloud,
                                                   std::span<const std::uint32_t> ray) {
  std::map<std::uint32_t, std::size_t> first;
  for (const std::uint32_t i : finite_points(cloud)) {
    const auto [entry, added] = first.try_emplace(ray[i], i);
    if (!added && cloud.points[i].norm() < cloud.points[entry->second].norm()) entry->second = i;
  }
  return first;
}

struct RangeErrors {
  std::vector<double> signed_m, unsigned_m;
  NormalisedErrors normalised;
};

// By the covariance, which knows the line on which the device measured (a moving camera's is not
// the line from the scanner's origin), else by sigma along the ray.
std::optional<double> normalised(const PointCloud& cloud, std::size_t i,
                                 const Eigen::Vector3d& error_m, double along_ray_m) {
  if (!cloud.covariances.empty()) return normalised_square(error_m, cloud.covariances[i]);
  if (cloud.sigma_m.empty() || !(cloud.sigma_m[i] > 0)) return std::nullopt;
  return (along_ray_m / cloud.sigma_m[i]) * (along_ray_m / cloud.sigma_m[i]);
}

RangeErrors range_errors(const PointCloud& cloud, std::span<const std::uint32_t> ray,
                         const ScanTruth& truth) {
  RangeErrors errors;
  for (const auto& [r, i] : first_returns(cloud, ray)) {
    const RayTruth& hit = truth.rays[r];
    if (hit.object < 0) continue;
    const Eigen::Vector3d along = hit.point_in_scanner.normalized();
    const Eigen::Vector3d error_m = cloud.points[i] - hit.point_in_scanner;
    const double along_ray_m = along.dot(error_m);
    errors.signed_m.push_back(along_ray_m);
    errors.unsigned_m.push_back(std::abs(along_ray_m));
    if (const auto square = normalised(cloud, i, error_m, along_ray_m))
      errors.normalised.squares.push_back(*square);
  }
  return errors;
}

}  // namespace

std::vector<Measurement> range_error(const PointCloud& cloud, std::span<const std::uint32_t> ray,
                                     const ScanTruth& truth) {
  check_input(cloud, ray, truth);
  std::size_t truly_hit = 0;
  for (const RayTruth& hit : truth.rays) truly_hit += hit.object >= 0;
  const RangeErrors errors = range_errors(cloud, ray, truth);
  const auto figure = [](const char* name, double value, const char* unit, const char* over,
                         std::size_t count) {
    return Measurement{.name = name, .value = value, .unit = unit, .over = over, .count = count};
  };
  const char* over = "first returns of rays that truly hit";
  const std::size_t count = errors.signed_m.size();
  std::vector<Measurement> figures = {
      figure("range_error_bias", mean(errors.signed_m), "m", over, count),
      figure("range_error_rms", root_mean_square(errors.signed_m), "m", over, count),
      figure("range_error_p95", quantile(errors.unsigned_m, 0.95), "m", over, count),
      figure("ray_hit_fraction", static_cast<double>(count) / static_cast<double>(truly_hit), "1",
             "rays that truly hit", truly_hit)};
  for (Measurement& stated :
       stated_uncertainty("range", errors.normalised, "first returns with a sigma"))
    figures.push_back(std::move(stated));
  return figures;
}

}  // namespace scan
