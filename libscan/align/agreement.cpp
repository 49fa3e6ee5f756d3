// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/agreement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "libscan/align/loss.h"
#include "libscan/core/median.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t most_samples = 1024;
constexpr double least_cosine = 0.5;
constexpr double tolerance_in_sigmas = 3;
constexpr double tolerance_in_spacings = 0.25;

std::size_t stride_of(const PreparedCloud& cloud) {
  return std::max<std::size_t>(1, cloud.size() / most_samples);
}

std::optional<Neighbour> nearest(const PreparedCloud& cloud, const Eigen::Vector3d& query,
                                 double most_m) {
  return std::visit([&](const auto& search) { return search.nearest(query, most_m); },
                    cloud.search);
}

enum class Meeting : std::uint8_t { none, apart, agreeing };

Meeting meet(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double tolerance_m,
             std::span<const PosedScan> others, double reach_m) {
  Meeting meeting = Meeting::none;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const PosedScan& other : others) {
    const Eigen::Vector3d moved = other.world_from_local.inverse() * point;
    const auto found = nearest(*other.cloud, moved, reach_m);
    if (!found || found->distance2_m2 >= nearest_m * nearest_m) continue;
    const Eigen::Vector3d& there = other.cloud->normals[found->index];
    if (there.isZero(0)) continue;
    if ((other.world_from_local.linear() * there).dot(normal) < least_cosine) continue;
    nearest_m = std::sqrt(found->distance2_m2);
    const double residual_m = std::abs(there.dot(moved - other.cloud->points[found->index]));
    meeting =
        residual_m <= std::max(tolerance_m, other.tolerance_m) ? Meeting::agreeing : Meeting::apart;
  }
  return meeting;
}

}  // namespace

double tolerated_residual_m(const PreparedCloud& cloud, double sigma_m) {
  if (cloud.size() < 2) return 0;
  const std::size_t stride = stride_of(cloud);
  const std::size_t count = (cloud.size() + stride - 1) / stride;
  std::vector<double> distances_m(count), residuals_m(count, -1);
  parallel_for(count, [&](std::size_t k) {
    const std::size_t i = k * stride;
    std::vector<Neighbour> found;
    std::visit([&](const auto& search) { search.k_nearest(cloud.points[i], 2, found); },
               cloud.search);
    const Neighbour& near = found[found[0].index == i ? 1 : 0];
    distances_m[k] = std::sqrt(near.distance2_m2);
    const Eigen::Vector3d& normal = cloud.normals[near.index];
    if (normal.isZero(0)) return;
    residuals_m[k] = std::abs(normal.dot(cloud.points[i] - cloud.points[near.index]));
  });
  std::erase(residuals_m, -1);
  const double own_m = sigma_from_median * median(std::move(residuals_m));
  return std::max(tolerance_in_sigmas * std::max(own_m, sigma_m),
                  tolerance_in_spacings * median(std::move(distances_m)));
}

Agreement agreement(const PosedScan& scan, std::span<const PosedScan> others, double reach_m) {
  const PreparedCloud& cloud = *scan.cloud;
  const std::size_t stride = stride_of(cloud);
  std::vector<Meeting> meetings((cloud.size() + stride - 1) / stride, Meeting::none);
  parallel_for(meetings.size(), [&](std::size_t k) {
    const std::size_t i = k * stride;
    if (cloud.normals[i].isZero(0)) return;
    meetings[k] =
        meet(scan.world_from_local * cloud.points[i],
             scan.world_from_local.linear() * cloud.normals[i], scan.tolerance_m, others, reach_m);
  });
  const auto count = [&](Meeting kind) {
    return static_cast<double>(std::count(meetings.begin(), meetings.end(), kind));
  };
  const double agreeing = count(Meeting::agreeing), met = agreeing + count(Meeting::apart);
  if (met == 0) return {};
  return {met / static_cast<double>(meetings.size()), agreeing / met};
}

}  // namespace scan
