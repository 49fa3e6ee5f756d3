// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/local_surface.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

// Twice the customary neighbourhood of 16, so that the further half shares no point with it.
constexpr std::size_t neighbours = 32;
// Fewer points in a fit say nothing about a surface: they are landmarks.
constexpr std::size_t least_points_of_fit = 6;
// A fit is flat (or straight) when its thickness is below a fifth of its breadth.
constexpr double thin_variance_ratio = 0.04;

std::vector<Eigen::Vector3d> without_repeats(std::span<const Eigen::Vector3d> points) {
  std::vector<Eigen::Vector3d> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
  });
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  return sorted;
}

struct Spread {
  Eigen::Vector3d variances;   // ascending
  Eigen::Matrix3d directions;  // columns
};

Spread spread_of(std::span<const Neighbour> found, const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  const Eigen::Vector3d& first = points[found[0].index];
  for (const Neighbour& n : found) mean += points[n.index] - first;
  mean /= static_cast<double>(found.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Neighbour& n : found) {
    const Eigen::Vector3d d = points[n.index] - first - mean;
    covariance += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

bool is_line(const Spread& s) { return s.variances[1] < thin_variance_ratio * s.variances[2]; }
bool is_surface(const Spread& s) {
  return !is_line(s) && s.variances[0] < thin_variance_ratio * s.variances[1];
}

}  // namespace

LocalSurface::LocalSurface(std::span<const Eigen::Vector3d> points)
    : points_(points),
      distinct_(without_repeats(points)),
      tree_(distinct_),
      fits_(points.size()),
      made_(points.size(), false) {
  if (distinct_.size() < 2) return;
  const std::size_t stride = std::max<std::size_t>(1, distinct_.size() / 2048);
  std::vector<double> distances2((distinct_.size() + stride - 1) / stride);
  parallel_for(distances2.size(), [&](std::size_t i) {
    std::vector<Neighbour> found;
    tree_.k_nearest(distinct_[i * stride], 2, found);
    distances2[i] = found[1].distance2_m2;
  });
  const auto middle = distances2.begin() + static_cast<std::ptrdiff_t>(distances2.size() / 2);
  std::nth_element(distances2.begin(), middle, distances2.end());
  spacing_m_ = std::sqrt(*middle);
}

void LocalSurface::prepare(std::span<const std::uint32_t> indices) {
  std::vector<std::uint32_t> missing;
  for (const std::uint32_t i : indices) {
    if (!made_[i]) missing.push_back(i);
    made_[i] = true;
  }
  parallel_for(missing.size(), [&](std::size_t i) { fits_[missing[i]] = fit_at(points_[missing[i]]); });
}

LocalFit LocalSurface::fit_at(const Eigen::Vector3d& point) const {
  std::vector<Neighbour> found;
  tree_.k_nearest(point, neighbours + 1, found);
  LocalFit fit;
  const std::size_t near = found.size() / 2 + 1;
  if (near < least_points_of_fit) {
    fit.shape = LocalShape::volume;
    return fit;
  }
  const std::span<const Neighbour> all = found;
  const Spread inner = spread_of(all.first(near), distinct_);
  fit.shape = is_line(inner)      ? LocalShape::line
              : is_surface(inner) ? LocalShape::surface
                                  : LocalShape::volume;
  fit.direction = inner.directions.col(fit.shape == LocalShape::line ? 2 : 0);
  if (fit.shape != LocalShape::surface || found.size() - near < 3) return fit;
  const Spread outer = spread_of(all.subspan(near), distinct_);
  if (!is_line(outer)) fit.second_normal = outer.directions.col(0);
  return fit;
}

}  // namespace scan
