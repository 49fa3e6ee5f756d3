// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/surface_weights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/local_smoothing.h"

namespace scan {
namespace {

constexpr double reach_in_lengths = 4, around_in_lengths = 2;
constexpr std::size_t least_neighbours = 6, most_around = 256;
constexpr double least_agreement = 0.5;                          // of normals
constexpr double tolerated_sigmas = 4, tolerated_lengths = 0.5;  // as in ssd_fit.cpp
constexpr double most_raised = 4;                                // at which a wave is halved
constexpr double half_wave = std::numbers::pi * lengths_per_cell;

double response(double x) {
  return 1 / (1 + x * x * x) / (1 + std::pow(x / half_wave, 8));
}

// The Hankel transform of the response, times length^2. Waves of six times the last that cells hold
// are answered by 1e-6.
class EquivalentKernel {
 public:
  EquivalentKernel() {
    constexpr double step = 0.01;
    constexpr int steps = static_cast<int>(6 * half_wave / step);
    for (std::size_t i = 0; i < table_.size(); ++i) {
      const double r = static_cast<double>(i) * reach_in_lengths / last;
      for (int k = 0; k < steps; ++k) {
        const double x = (k + 0.5) * step;
        table_[i] += response(x) * x * std::cyl_bessel_j(0, x * r) * step / (2 * std::numbers::pi);
      }
    }
  }
  double operator()(double lengths) const {
    const double at = lengths / reach_in_lengths * last;
    if (!(at < last)) return 0;
    const auto i = static_cast<std::size_t>(at);
    return std::lerp(table_[i], table_[i + 1], at - static_cast<double>(i));
  }

 private:
  static constexpr double last = 400;
  std::array<double, 401> table_{};
};

const EquivalentKernel& equivalent_kernel() {
  static const EquivalentKernel kernel;
  return kernel;
}

}  // namespace

SurfaceWeights::SurfaceWeights(const Mesh& surface, std::span<const double> smoothing_m,
                               const PointCloud& cloud)
    : surface_(surface),
      smoothing_m_(smoothing_m),
      cloud_(cloud),
      normals_(vertex_normals(surface)),
      tree_(cloud.points),
      feet_(cloud.size()) {
  const std::vector<ClosestPoint> closest = closest_of_each(MeshSearch(surface), cloud.points);
  parallel_for(feet_.size(), [&](std::size_t i) { feet_[i] = foot_of(i, closest[i]); });
}

// The distance is the mean of those from the facet and from the planes of its corners, which a
// paraboloid bends to either side alike.
SurfaceWeights::Foot SurfaceWeights::foot_of(std::size_t point, const ClosestPoint& closest) const {
  Foot foot{.corners = surface_.triangles[closest.triangle], .shares = {1, 0, 0}};
  const Eigen::Vector3d &x = cloud_.points[point], &corner = surface_.vertices[foot.corners[0]];
  const Eigen::Vector3d u = surface_.vertices[foot.corners[1]] - corner,
                        v = surface_.vertices[foot.corners[2]] - corner, normal = u.cross(v),
                        w = closest.point - corner;
  if (const double area2 = normal.squaredNorm(); area2 > 0) {
    foot.shares[1] = w.cross(v).dot(normal) / area2;
    foot.shares[2] = u.cross(w).dot(normal) / area2;
    foot.shares[0] = 1 - foot.shares[1] - foot.shares[2];
  }
  Eigen::Vector3d upwards = Eigen::Vector3d::Zero();
  double from_planes = 0;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d& at = normals_[foot.corners[k]];
    upwards += foot.shares[k] * at;
    from_planes += foot.shares[k] * at.dot(x - surface_.vertices[foot.corners[k]]);
  }
  foot.residual_m = 0.5 * (upwards.normalized().dot(x - closest.point) + from_planes);
  return foot;
}

double SurfaceWeights::trust(std::uint32_t point, std::size_t vertex) const {
  double tolerance_m = tolerated_lengths * smoothing_m_[vertex];
  if (!cloud_.sigma_m.empty())
    tolerance_m = std::max(tolerance_m, tolerated_sigmas * cloud_.sigma_m[point]);
  const double share = tolerance_m / std::max(tolerance_m, std::abs(feet_[point].residual_m));
  return share * share * share * share;
}

std::vector<WeighedPoint> SurfaceWeights::at(std::size_t vertex) const {
  const double length_m = smoothing_m_[vertex];
  std::vector<Neighbour> found;
  tree_.within_unsorted(surface_.vertices[vertex], reach_in_lengths * length_m, found);
  if (found.size() < least_neighbours)
    tree_.k_nearest(surface_.vertices[vertex], least_neighbours, found);
  std::vector<WeighedPoint> weights;
  double sum = 0;
  for (const Neighbour& n : found) {
    if (!cloud_.normals.empty() && cloud_.normals[n.index].dot(normals_[vertex]) < least_agreement)
      continue;
    const double weight = equivalent_kernel()(std::sqrt(n.distance2_m2) / length_m);
    weights.push_back({n.index, weight * trust(n.index, vertex)});
    sum += weights.back().weight;
  }
  // Only far points, or none of its side: it hangs on the nearest.
  if (!(sum > 0)) return {{std::min_element(found.begin(), found.end(), nearer)->index, 1}};
  for (WeighedPoint& p : weights) p.weight /= sum;
  return weights;
}

double SurfaceWeights::mean_residual_m(std::span<const WeighedPoint> points) const {
  double mean_m = 0;
  for (const WeighedPoint& p : points) mean_m += p.weight * feet_[p.point].residual_m;
  return mean_m;
}

std::vector<double> SurfaceWeights::taken_m2(std::span<const double> once_m) const {
  std::vector<double> twice_m(once_m.size(), 0.0);
  parallel_for(twice_m.size(), [&](std::size_t v) {
    for (const WeighedPoint& p : at(v)) {
      const Foot& foot = feet_[p.point];
      for (int k = 0; k < 3; ++k) twice_m[v] += p.weight * foot.shares[k] * once_m[foot.corners[k]];
    }
  });
  const KdTree tree(surface_.vertices);
  std::vector<double> taken(once_m.size());
  parallel_for(taken.size(), [&](std::size_t v) {
    std::vector<Neighbour> around;
    tree.within(surface_.vertices[v], around_in_lengths * smoothing_m_[v], around);
    if (around.size() > most_around) around.resize(most_around);
    double once_m2 = 0, twice_m2 = 0, count = 0;
    for (const Neighbour& n : around) {
      once_m2 += once_m[n.index] * once_m[n.index];
      twice_m2 += twice_m[n.index] * twice_m[n.index];
      count += 1;
    }
    const double raised = std::clamp(once_m2 / std::max(twice_m2, 1e-300), 1.0, most_raised);
    taken[v] = raised * once_m2 / count;  // the vertex itself is one
  });
  return taken;
}

}  // namespace scan
