// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/prepared_cloud.h"

#include <cmath>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/median.h"
#include "libscan/core/parallel.h"
#include "libscan/search/batch.h"
#include "libscan/search/voxel_grid.h"

namespace scan {
namespace {

// Half of the given normals may differ from the fitted ones by so much (12 degrees: what fits over
// other neighbours differ by at noise and edges that still leave a surface); more is another's.
constexpr double most_median_sine = 0.2;
constexpr std::size_t most_compared = 2048;

Eigen::Vector3d mean_of(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point - points[0];
  return points[0] + sum / static_cast<double>(points.size());
}

// The finite points about their mean, along the curve.
void localise(const PointCloud& cloud, PreparedCloud& prepared) {
  const std::vector<std::uint32_t> valid = finite_points(cloud);
  prepared.invalid_points += cloud.size() - valid.size();
  if (valid.empty()) return;
  std::vector<Eigen::Vector3d> points;
  points.reserve(valid.size());
  for (const std::uint32_t i : valid) points.push_back(cloud.points[i]);
  prepared.origin = mean_of(points);
  for (Eigen::Vector3d& point : points) point -= prepared.origin;
  double sum2 = 0;
  for (const std::uint32_t place : curve_order(points)) {
    const std::uint32_t i = valid[place];
    prepared.index.push_back(i);
    prepared.points.push_back(points[place]);
    sum2 += points[place].squaredNorm();
    if (!cloud.normals.empty()) prepared.normals.push_back(cloud.normals[i].normalized());
    if (!cloud.covariances.empty()) prepared.covariances.push_back(cloud.covariances[i]);
  }
  prepared.radius_m = std::sqrt(sum2 / static_cast<double>(valid.size()));
}

bool are_of_others(const PreparedCloud& prepared) {
  std::vector<double> sines;
  const std::size_t stride = std::max<std::size_t>(1, prepared.size() / most_compared);
  for (std::size_t i = 0; i < prepared.size(); i += stride) {
    const LocalFit& fit = prepared.fits[i];
    if (fit.shape != LocalShape::surface || prepared.normals[i].isZero(0)) continue;
    sines.push_back(fit.direction.cross(prepared.normals[i]).norm());
  }
  return median(std::move(sines)) > most_median_sine;
}

void choose_normals(PreparedCloud& prepared) {
  prepared.oriented = !prepared.normals.empty();
  prepared.normals_refused = prepared.oriented && are_of_others(prepared);
  if (prepared.oriented && !prepared.normals_refused) return;
  prepared.normals.resize(prepared.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < prepared.size(); ++i) {
    const LocalFit& fit = prepared.fits[i];
    Eigen::Vector3d& normal = prepared.normals[i];
    const double sign = normal.dot(fit.direction) < 0 ? -1 : 1;
    normal = fit.shape == LocalShape::surface ? Eigen::Vector3d(sign * fit.direction)
                                              : Eigen::Vector3d::Zero();
  }
}

}  // namespace

void check(const PrepareOptions& options) {
  if (!(options.thin_m >= 0))
    throw Error(Trouble::usage,
                "prepare: thin_m: " + std::to_string(options.thin_m) + ", must be at least 0");
  if (options.neighbours < 6)
    throw Error(Trouble::usage, "prepare: neighbours: " + std::to_string(options.neighbours) +
                                    ", must be 6 or more");
}

PreparedCloud prepare(const PointCloud& cloud, const PrepareOptions& options) {
  check(options);
  check(cloud);
  PreparedCloud prepared;
  if (options.thin_m > 0) {
    prepared.invalid_points = cloud.size() - finite_points(cloud).size();
    localise(voxel_grid(cloud, options.thin_m), prepared);
  } else {
    localise(cloud, prepared);
  }
  prepared.search = make_search(options.search, prepared.points);
  prepared.fits =
      local_fits(prepared.points, prepared.search, static_cast<std::size_t>(options.neighbours));
  prepared.spacing_m = spacing_m(prepared.points, prepared.search);
  choose_normals(prepared);
  return prepared;
}

std::pair<PreparedCloud, PreparedCloud> prepare_pair(const PointCloud& source,
                                                     const PointCloud& target,
                                                     const PrepareOptions& options) {
  std::pair<PreparedCloud, PreparedCloud> pair;
  parallel_for(
      2,
      [&](std::size_t i) {
        (i == 0 ? pair.first : pair.second) = prepare(i == 0 ? source : target, options);
      },
      1);
  return pair;
}

Pose with_proper_rotation(const Pose& pose) {
  const Eigen::Matrix3d nearest = nearest_rotation(pose.linear());
  const bool proper = (pose.linear() - nearest).norm() < 1e-14;
  return proper ? pose : make_pose(nearest, pose.translation());
}

Pose local_pose(const Pose& target_from_source, const PreparedCloud& source,
                const PreparedCloud& target) {
  return make_pose(target_from_source.linear(), target_from_source * source.origin - target.origin);
}

Pose global_pose(const Pose& local, const PreparedCloud& source, const PreparedCloud& target) {
  return make_pose(local.linear(),
                   target.origin + local.translation() - local.linear() * source.origin);
}

}  // namespace scan
