// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which points a smoothed surface is made of at each of its vertices, and what smoothing takes.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "libscan/core/mesh.h"
#include "libscan/core/point_cloud.h"
#include "libscan/search/closest_point.h"
#include "libscan/search/kd_tree.h"

namespace scan {

struct WeighedPoint {
  std::uint32_t point = 0;
  double weight = 0;  // all of a vertex: 1
};

class SurfaceWeights {
 public:
  // `smoothing_m`: the smoothing length at each vertex; the points are finite. Keeps references.
  SurfaceWeights(const Mesh& surface, std::span<const double> smoothing_m, const PointCloud& cloud);

  // The surface at a vertex is the mean of the points within four lengths (at least of six),
  // weighed by the kernel that answers a ripple of x / length by R = 1 / (1 + x^3)
  // (local_smoothing.h), on cells that end with half a wave; points farther off the surface than
  // four sigma and half a length by the fourth power of that less, as the fit trusts them. Those
  // whose normals are more than 60 degrees from the vertex' do not count: the back of a thin wall.
  std::vector<WeighedPoint> at(std::size_t vertex) const;
  const Eigen::Vector3d& normal(std::size_t vertex) const { return normals_[vertex]; }

  // Expected square of what smoothing took from each vertex, m^2, over the vertices within two
  // lengths. Where a fit answers a wave by R it takes 1 - R of it. The points' residuals from it,
  // smoothed once more (Tukey's twicing, 1977), hold R (1 - R), and smoothed twice R^2 (1 - R): the
  // ratio of their squares raises the first to what was taken, at most fourfold, for waves that are
  // halved. What noise leaves in them counts, too.
  // `once_m`: the mean residual at each vertex.
  std::vector<double> taken_m2(std::span<const double> once_m) const;
  // Of points as at() gives them.
  double mean_residual_m(std::span<const WeighedPoint> points) const;

 private:
  // Where a point lies on the surface: nearest to it.
  struct Foot {
    Triangle corners{};
    Eigen::Vector3d shares = Eigen::Vector3d::Zero();  // of the corners
    double residual_m = 0;                             // signed distance from the surface
  };
  Foot foot_of(std::size_t point, const ClosestPoint& closest) const;
  double trust(std::uint32_t point, std::size_t vertex) const;

  const Mesh& surface_;
  std::span<const double> smoothing_m_;
  const PointCloud& cloud_;
  std::vector<Eigen::Vector3d> normals_;  // of the vertices
  KdTree tree_;                           // of the points
  std::vector<Foot> feet_;
};

}  // namespace scan
