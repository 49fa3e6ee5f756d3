// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/local_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "libscan/align/symmetric_matrix.h"
#include "libscan/core/median.h"
#include "libscan/core/parallel.h"
#include "libscan/search/patches.h"

namespace scan {
namespace {

// Fewer points in a fit say nothing about a surface: they are landmarks.
constexpr std::size_t least_points_of_fit = 6;
// A neighbourhood is straight when its breadth is below a fifth of its length, and flat when the
// variance across it is below a third of that along its narrower direction.
constexpr double line_variance_ratio = 0.04;
constexpr double plane_variance_ratio = 1.0 / 3;
constexpr std::size_t widest = 4;
constexpr std::size_t most_spacings = 512;

// Central second moments of the neighbours, and those of every other one less those of the rest.
struct Moments {
  Eigen::Matrix3d all = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d halves = Eigen::Matrix3d::Zero();
};

Moments moments_of(std::span<const Neighbour> found, std::span<const Eigen::Vector3d> points) {
  const Eigen::Vector3d& first = points[found[0].index];
  const auto count = static_cast<double>(found.size());
  Eigen::Vector3d sum[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (std::size_t i = 0; i < found.size(); ++i) sum[i % 2] += points[found[i].index] - first;
  const Eigen::Vector3d mean = (sum[0] + sum[1]) / count;
  // Each half about its own mean: sum of d d^T less n m m^T, d and m from the common mean.
  SymmetricSum squares[2];
  for (std::size_t i = 0; i < found.size(); ++i)
    squares[i % 2].add(points[found[i].index] - first - mean);
  Eigen::Matrix3d half[2];
  for (std::size_t h = 0; h < 2; ++h) {
    const auto n = static_cast<double>((found.size() + 1 - h) / 2);
    const Eigen::Vector3d offset = sum[h] - n * mean;
    half[h] = squares[h].matrix() - offset * offset.transpose() / n;
  }
  return {squares[0].matrix() + squares[1].matrix(), half[0] - half[1]};
}

// First order: C + E has the normal n - (C - l0)^-1 E n, the inverse taken in the plane (Kato
// 1995, section II.2). The halves' moments are (C +- D) / 2 up to their means, so their normals
// differ by 2 (C - l0)^-1 D n, and half of that is the tilt.
Eigen::Vector3d tilt_of(const Moments& moments, const Eigen::Vector3d& normal, double least) {
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  const Eigen::Vector3d cu = moments.all * u, cv = moments.all * v;
  const double uu = u.dot(cu) - least, vv = v.dot(cv) - least, uv = u.dot(cv);
  const Eigen::Vector3d pull = moments.halves * normal;
  const double pu = u.dot(pull), pv = v.dot(pull);
  const double determinant = uu * vv - uv * uv;
  return (-(vv * pu - uv * pv) * u - (uu * pv - uv * pu) * v) / determinant;
}

LocalFit fit_to(std::span<const Neighbour> found, std::span<const Eigen::Vector3d> points) {
  LocalFit fit;
  const double reach_m = std::sqrt(found.back().distance2_m2);
  fit.reach_m = static_cast<float>(reach_m);
  fit.shape = LocalShape::volume;
  if (found.size() < least_points_of_fit) return fit;
  const Moments moments = moments_of(found, points);
  const Eigen::Vector3d spread = eigenvalues_of(moments.all);
  const double rounding_m = 0x1p-50 * points[found[0].index].cwiseAbs().maxCoeff();
  const auto count = static_cast<double>(found.size());
  if (!(spread[2] > count * rounding_m * rounding_m)) {
    fit.shape = LocalShape::unknown;
  } else if (spread[1] < line_variance_ratio * spread[2]) {
    fit.shape = LocalShape::line;
    fit.direction = eigenvector_of(moments.all, spread[2]);
  } else if (spread[0] < plane_variance_ratio * spread[1]) {
    fit.shape = LocalShape::surface;
    fit.direction = eigenvector_of(moments.all, spread[0]);
    fit.tilt = tilt_of(moments, fit.direction, spread[0]).cast<float>();
    const Eigen::Vector3d apart = points[found[1].index] - points[found[0].index];
    fit.neighbour_off_m = static_cast<float>(std::abs(fit.direction.dot(apart)));
  }
  return fit;
}

// Repeated points and scan lines that lie far apart hide the surface from the nearest points.
bool is_worth_widening(const LocalFit& fit) {
  return fit.shape == LocalShape::line || fit.shape == LocalShape::unknown;
}

// Of the points found that coincide, which follow one another but for others just as far, leaves
// one.
void merge_coincident(std::span<const Eigen::Vector3d> points, std::vector<Neighbour>& found) {
  for (std::size_t a = 0; a + 1 < found.size(); ++a)
    for (std::size_t b = a + 1; b < found.size() && found[b].distance2_m2 == found[a].distance2_m2;)
      if (points[found[b].index] == points[found[a].index])
        found.erase(found.begin() + static_cast<std::ptrdiff_t>(b));
      else
        ++b;
}

// The nearest `count` places to point i, of which `found` holds the nearest points.
template <class S>
void complete_places(std::span<const Eigen::Vector3d> points, std::size_t i, const S& search,
                     std::size_t count, std::vector<Neighbour>& found) {
  for (std::size_t k = found.size();; k *= 4) {
    const bool all = found.size() == points.size();
    merge_coincident(points, found);
    if (all || found.size() >= count) break;
    search.k_nearest(points[i], 4 * k, found);
  }
  if (found.size() > count) found.resize(count);
}

template <class S>
std::vector<LocalFit> fits_by(std::span<const Eigen::Vector3d> points, const S& search,
                              std::size_t neighbours) {
  std::vector<LocalFit> fits(points.size());
  k_nearest_of_own(search, points, neighbours, [&](std::uint32_t i, std::vector<Neighbour>& found) {
    complete_places(points, i, search, neighbours, found);
    fits[i] = fit_to(found, points);
    for (std::size_t more = 4;
         more <= widest && found.size() >= neighbours && is_worth_widening(fits[i]); more *= 4) {
      search.k_nearest(points[i], more * neighbours, found);
      complete_places(points, i, search, more * neighbours, found);
      const LocalFit wider = fit_to(found, points);
      if (wider.shape == LocalShape::surface || fits[i].shape == LocalShape::unknown)
        fits[i] = wider;
    }
  });
  return fits;
}

template <class S>
double spacing_by(std::span<const Eigen::Vector3d> points, const S& search) {
  const std::size_t stride = std::max<std::size_t>(1, points.size() / most_spacings);
  std::vector<double> distances_m((points.size() + stride - 1) / stride, -1);
  parallel_for(distances_m.size(), [&](std::size_t k) {
    std::vector<Neighbour> found;
    for (std::size_t n = 2; distances_m[k] < 0; n *= 8) {
      search.k_nearest(points[k * stride], n, found);
      if (found.back().distance2_m2 > 0)
        distances_m[k] = std::sqrt(std::find_if(found.begin(), found.end(), [](const Neighbour& f) {
                                     return f.distance2_m2 > 0;
                                   })->distance2_m2);
      if (found.size() == points.size()) break;
    }
  });
  std::erase(distances_m, -1);
  return median(std::move(distances_m));
}

}  // namespace

std::vector<LocalFit> local_fits(std::span<const Eigen::Vector3d> points, const AnySearch& search,
                                 std::size_t neighbours) {
  return std::visit([&](const auto& tree) { return fits_by(points, tree, neighbours); }, search);
}

std::vector<LocalFit> local_fits(std::span<const Eigen::Vector3d> points, const KdTree& search,
                                 std::size_t neighbours) {
  return fits_by(points, search, neighbours);
}

double spacing_m(std::span<const Eigen::Vector3d> points, const AnySearch& search) {
  return std::visit([&](const auto& tree) { return spacing_by(points, tree); }, search);
}

double spacing_m(std::span<const Eigen::Vector3d> points, const KdTree& search) {
  return spacing_by(points, search);
}

}  // namespace scan
