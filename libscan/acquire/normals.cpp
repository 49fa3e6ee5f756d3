// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/normals.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/search/batch.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

// Neighbourhoods in the device's grid: fair to both directions even where steps lie much further
// apart than the pixels of one step.
class GridNeighbours {
 public:
  explicit GridNeighbours(const Scan& scan)
      : scan_(scan), point_of_ray_(std::size_t{scan.grid.rows} * scan.grid.columns, nowhere) {
    for (std::size_t i = 0; i < scan.ray.size(); ++i)
      if (scan.cloud.points[i].allFinite())
        point_of_ray_[scan.ray[i]] = static_cast<std::uint32_t>(i);
  }

  // Points of the (2 reach + 1)^2 window about a point, those beyond a jump left out: a point
  // counts as beyond when its distance per grid step is over five times the window's lower
  // quartile. On a plane that is the ratio of the steps' lengths along and across the tilt at 78
  // degrees.
  void around(std::uint32_t centre, int reach, std::vector<std::uint32_t>& found) const {
    struct Near {
      std::uint32_t point;
      double distance_per_step;
    };
    std::vector<Near> window;
    const int row = static_cast<int>(scan_.ray[centre] / scan_.grid.columns);
    const int column = static_cast<int>(scan_.ray[centre] % scan_.grid.columns);
    for (int r = std::max(0, row - reach); r <= std::min<int>(scan_.grid.rows - 1, row + reach);
         ++r)
      for (int c = std::max(0, column - reach);
           c <= std::min<int>(scan_.grid.columns - 1, column + reach); ++c) {
        const std::uint32_t point = point_of_ray_[std::size_t(r) * scan_.grid.columns + c];
        if (point == nowhere || point == centre) continue;
        const double distance_m = (scan_.cloud.points[point] - scan_.cloud.points[centre]).norm();
        window.push_back({point, distance_m / std::hypot(r - row, c - column)});
      }
    found.assign(1, centre);
    if (window.empty()) return;
    std::vector<double> ordered;
    ordered.reserve(window.size());
    for (const Near& near : window) ordered.push_back(near.distance_per_step);
    const auto quartile = ordered.begin() + static_cast<std::ptrdiff_t>(ordered.size() / 4);
    std::nth_element(ordered.begin(), quartile, ordered.end());
    for (const Near& near : window)
      if (near.distance_per_step <= 5 * *quartile) found.push_back(near.point);
  }

 private:
  const Scan& scan_;
  std::vector<std::uint32_t> point_of_ray_;
};

// Unit normal of the plane of least weighted squares, (0,0,0) if the points fix none: the variance
// across the plane must be below a third of the variance along its narrower direction, and the
// latter above the rounding of the coordinates.
Eigen::Vector3d plane_normal(const PointCloud& cloud, std::span<const std::uint32_t> points) {
  if (points.size() < 3) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d& origin = cloud.points[points.front()];
  double total = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : points) {
    const double sigma = cloud.sigma_m.empty() ? 1 : cloud.sigma_m[i];
    const double weight = sigma > 0 && std::isfinite(sigma) ? 1 / (sigma * sigma) : 0;
    const Eigen::Vector3d offset = cloud.points[i] - origin;
    total += weight;
    mean += weight * offset;
    moments += weight * offset * offset.transpose();
  }
  if (!(total > 0)) return Eigen::Vector3d::Zero();
  mean /= total;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments / total -
                                                              mean * mean.transpose());
  const Eigen::Vector3d& spread = solver.eigenvalues();  // ascending
  const double rounding = std::numeric_limits<double>::epsilon() * origin.cwiseAbs().maxCoeff();
  const double least =
      16 * std::max(rounding * rounding, std::numeric_limits<double>::epsilon() * spread(2));
  if (!(spread(1) > least) || !(3 * spread(0) < spread(1))) return Eigen::Vector3d::Zero();
  return solver.eigenvectors().col(0).normalized();
}

void check(const Scan& scan, const NormalOptions& options,
           std::span<const Eigen::Vector3d> viewpoints) {
  scan::check(scan.cloud);
  if (options.neighbours < 3)
    throw Error(Trouble::usage, "normals/neighbours: " + std::to_string(options.neighbours) +
                                    ", must be 3 or more");
  if (!viewpoints.empty() && viewpoints.size() != scan.cloud.size())
    throw Error(Trouble::usage, "normals: " + std::to_string(viewpoints.size()) +
                                    " viewpoints for " + std::to_string(scan.cloud.size()) +
                                    " points");
}

bool has_grid(const Scan& scan) {
  const std::size_t cells = std::size_t{scan.grid.rows} * scan.grid.columns;
  return scan.grid.rows > 1 && scan.grid.columns > 1 && scan.ray.size() == scan.cloud.size() &&
         std::all_of(scan.ray.begin(), scan.ray.end(),
                     [&](std::uint32_t ray) { return ray < cells; });
}

// around(i, widening, found) gives the neighbours of point i, itself first. Up to two times, a
// neighbourhood that fixes no plane is doubled in reach. `order`: of the points, in which one finds
// what the last one left in the processor's caches.
template <class Around>
void fit_planes(Scan& scan, std::span<const Eigen::Vector3d> viewpoints,
                std::span<const std::uint32_t> order, Around&& around) {
  PointCloud& cloud = scan.cloud;
  cloud.normals.assign(cloud.size(), Eigen::Vector3d::Zero());
  parallel_chunks(order.size(), queries_per_task, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> neighbours;
    for (const std::uint32_t i : order.subspan(begin, end - begin)) {
      if (!cloud.points[i].allFinite()) continue;
      Eigen::Vector3d& normal = cloud.normals[i];
      for (int widening = 1; widening <= 4 && normal.isZero(0); widening *= 2) {
        around(i, widening, neighbours);
        normal = plane_normal(cloud, neighbours);
      }
      const Eigen::Vector3d viewpoint = viewpoints.empty() ? scan.viewpoint : viewpoints[i];
      if (normal.dot(viewpoint - cloud.points[i]) < 0) normal = -normal;
    }
  });
}

}  // namespace

void estimate_normals(Scan& scan, const NormalOptions& options,
                      std::span<const Eigen::Vector3d> viewpoints) {
  check(scan, options, viewpoints);
  if (has_grid(scan)) {
    const GridNeighbours grid(scan);
    const int reach =
        std::max(1, static_cast<int>(std::ceil((std::sqrt(options.neighbours + 1.0) - 1) / 2)));
    std::vector<std::uint32_t> order(scan.cloud.size());
    std::iota(order.begin(), order.end(), 0u);
    fit_planes(scan, viewpoints, order,
               [&](std::uint32_t i, int widening, std::vector<std::uint32_t>& found) {
                 grid.around(i, reach * widening, found);
               });
    return;
  }
  const KdTree tree(scan.cloud.points);
  fit_planes(scan, viewpoints, curve_order(scan.cloud.points),
             [&](std::uint32_t i, int widening, std::vector<std::uint32_t>& found) {
               std::vector<Neighbour> near;
               tree.k_nearest(
                   scan.cloud.points[i],
                   static_cast<std::size_t>(options.neighbours) * widening * widening + 1, near);
               found.assign(1, i);
               for (const Neighbour& one : near)
                 if (one.index != i) found.push_back(one.index);
             });
}

}  // namespace scan
