// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/surface_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/surface_weights.h"

namespace scan {
namespace {

void check(const PointCloud& cloud, const CommonErrors& common) {
  scan::check(cloud);
  for (const auto& [what, count] : {std::pair("scan numbers", common.scan.size()),
                                    std::pair("places of rays", common.in_windows.size())})
    if (count != 0 && count != cloud.size())
      throw Error(Trouble::input, "surface uncertainty: " + std::to_string(count) + " " + what +
                                      " for " + std::to_string(cloud.size()) + " points");
  const std::size_t stated = common.poses.scans.size();
  if (stated == 0) return;
  const std::uint32_t last =
      common.scan.empty() ? 0 : *std::max_element(common.scan.begin(), common.scan.end());
  if (last >= stated)
    throw Error(Trouble::input, "surface uncertainty: a point is of scan " + std::to_string(last) +
                                    ", but " + std::to_string(stated) + " poses are stated");
}

// One at a vertex.
class Patch {
 public:
  Patch(const PointCloud& cloud, const CommonErrors& common, double sigma_m,
        std::span<const WeighedPoint> points, const Eigen::Vector3d& normal)
      : cloud_(cloud), common_(common), points_(points), normal_(normal) {
    for (const WeighedPoint& p : points_) sigma_.push_back(p.weight * across(p.point, sigma_m));
  }

  double of_points() const {
    return common_.in_windows.empty() ? independent() : independent() + shared();
  }

  double of_poses() const {
    if (common_.poses.scans.empty()) return 0;
    std::vector<Eigen::Vector4d> sums(common_.poses.scans.size(), Eigen::Vector4d::Zero());
    std::vector<bool> takes_part(sums.size(), false);
    for (const WeighedPoint& p : points_) {
      sums[scan_of(p.point)] += p.weight * cloud_.points[p.point].homogeneous();
      takes_part[scan_of(p.point)] = true;
    }
    std::vector<Lever> levers;
    for (std::uint32_t s = 0; s < sums.size(); ++s) {
      if (!takes_part[s]) continue;
      const auto& stated = common_.poses.scans[s];
      if (!stated) return std::numeric_limits<double>::infinity();
      const double weight = sums[s].w();
      Vector6 lever;
      lever << (sums[s].head<3>() - weight * stated->centre).cross(normal_), weight * normal_;
      levers.emplace_back(s, lever);
    }
    double sum = 0;
    for (auto a = levers.begin(); a != levers.end(); ++a) {
      sum += own(*a);
      for (auto b = levers.begin(); b != a; ++b) sum += 2 * between(*b, *a);
    }
    return std::max(sum, 0.0);
  }

 private:
  using Lever = std::pair<std::uint32_t, Vector6>;

  // Were each point's error its own.
  double independent() const {
    double sum = 0;
    for (const double s : sigma_) sum += s * s;
    return sum;
  }

  // What their correlations add.
  double shared() const {
    // Those that may share noise, of one scan and within a window's rows, follow one another.
    using Place = std::tuple<std::uint32_t, double, std::size_t>;
    std::vector<Place> places;
    for (std::size_t i = 0; i < points_.size(); ++i)
      places.emplace_back(scan_of(points_[i].point), common_.in_windows[points_[i].point].x(), i);
    std::sort(places.begin(), places.end());
    const auto count = static_cast<Eigen::Index>(places.size());
    Eigen::ArrayXd row(count), column(count), sigma(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const std::size_t i = std::get<2>(places[static_cast<std::size_t>(k)]);
      row(k) = common_.in_windows[points_[i].point].x();
      column(k) = common_.in_windows[points_[i].point].y();
      sigma(k) = sigma_[i];
    }
    double sum = 0;
    const auto scan = [&](Eigen::Index k) {
      return std::get<0>(places[static_cast<std::size_t>(k)]);
    };
    for (Eigen::Index k = 0, end = 0; k < count; ++k) {
      while (end < count && (end <= k || (scan(end) == scan(k) && row(end) - row(k) < 1))) ++end;
      const Eigen::Index first = k + 1, others = end - first;
      sum += 2 * sigma(k) *
             (sigma.segment(first, others) * (1 + row(k) - row.segment(first, others)) *
              (1 - (column.segment(first, others) - column(k)).abs()).max(0))
                 .sum();
    }
    return sum;
  }

  std::uint32_t scan_of(std::uint32_t point) const {
    return common_.scan.empty() ? 0 : common_.scan[point];
  }

  double across(std::uint32_t point, double sigma_m) const {
    if (!cloud_.covariances.empty())
      return std::sqrt(std::max(0.0, normal_.dot(cloud_.covariances[point] * normal_)));
    return cloud_.sigma_m.empty() ? sigma_m : cloud_.sigma_m[point];
  }

  // Rounding takes what a covariance leaves out below zero.
  double own(const Lever& lever) const {
    const Matrix6& covariance = common_.poses.scans[lever.first]->covariance;
    return std::max(0.0, lever.second.dot(covariance * lever.second));
  }

  // Of scans that no couple ties it is not known: at most the root of both variances' product.
  double between(const Lever& first, const Lever& second) const {
    const auto& all = common_.poses.between;
    const auto at = std::lower_bound(all.begin(), all.end(), std::pair(first.first, second.first),
                                     [](const CommonCovariance& one, const auto& scans) {
                                       return std::pair(one.first, one.second) <
                                              std::pair<std::size_t, std::size_t>(scans);
                                     });
    if (at != all.end() && at->first == first.first && at->second == second.first)
      return first.second.dot(at->covariance * second.second);
    return std::sqrt(own(first) * own(second));
  }

  const PointCloud& cloud_;
  const CommonErrors& common_;
  std::span<const WeighedPoint> points_;
  Eigen::Vector3d normal_;
  std::vector<double> sigma_;  // of each point across the surface, times its weight
};

}  // namespace

CommonErrors common_errors(std::span<const Scan> scans, StatedPoses poses) {
  CommonErrors common{.poses = std::move(poses)};
  bool shared = false;
  for (const Scan& scan : scans) {
    const bool placed = scan.grid.columns > 0 && scan.ray.size() == scan.cloud.size();
    shared |= placed && (scan.noise_window.rows > 1 || scan.noise_window.columns > 1);
    for (std::size_t k = 0; k < scan.cloud.size(); ++k) {
      common.scan.push_back(static_cast<std::uint32_t>(&scan - scans.data()));
      if (!placed) {  // one apart: each has its own
        common.in_windows.emplace_back(static_cast<double>(k), 0);
        continue;
      }
      const double row = scan.ray[k] / scan.grid.columns, column = scan.ray[k] % scan.grid.columns;
      common.in_windows.emplace_back(row / scan.noise_window.rows,
                                     column / scan.noise_window.columns);
    }
  }
  if (!shared) common.in_windows.clear();
  return common;
}

CommonErrors subset(const CommonErrors& common, std::span<const std::uint32_t> indices) {
  CommonErrors some{.scan = {}, .in_windows = {}, .poses = common.poses};
  for (const std::uint32_t i : indices) {
    if (!common.scan.empty()) some.scan.push_back(common.scan[i]);
    if (!common.in_windows.empty()) some.in_windows.push_back(common.in_windows[i]);
  }
  return some;
}

std::vector<SurfaceVariance> surface_variances(const SurfaceResult& surface,
                                               const PointCloud& cloud,
                                               const CommonErrors& common) {
  check(cloud, common);
  if (surface.vertex_smoothing_m.empty()) return {};
  const std::vector<std::uint32_t> valid = finite_points(cloud);
  if (valid.size() < cloud.size())
    return surface_variances(surface, subset(cloud, valid), subset(common, valid));
  const SurfaceWeights weights(surface.surface, surface.vertex_smoothing_m, cloud);
  std::vector<SurfaceVariance> variances(surface.surface.vertices.size());
  std::vector<double> residuals_m(variances.size());
  parallel_for(variances.size(), [&](std::size_t v) {
    const std::vector<WeighedPoint> points = weights.at(v);
    const Patch patch(cloud, common, surface.sigma_m, points, weights.normal(v));
    residuals_m[v] = weights.mean_residual_m(points);
    variances[v] = {.points_m2 = patch.of_points(), .poses_m2 = patch.of_poses()};
  });
  const std::vector<double> taken_m2 = weights.taken_m2(residuals_m);
  for (std::size_t v = 0; v < taken_m2.size(); ++v) variances[v].smoothing_m2 = taken_m2[v];
  return variances;
}

void add_standard_errors(SurfaceResult& surface, const PointCloud& cloud,
                         const CommonErrors& common) {
  const std::vector<SurfaceVariance> variances = surface_variances(surface, cloud, common);
  if (variances.empty()) return;
  surface.standard_error_m.clear();
  for (const SurfaceVariance& one : variances)
    surface.standard_error_m.push_back(std::sqrt(one.total_m2()));
}

}  // namespace scan
