// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/range_fusion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <tuple>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/core/shortest.h"
#include "libscan/reconstruct/followed_surface.h"
#include "libscan/reconstruct/ray_bricks.h"
#include "libscan/reconstruct/world_surface.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr double beside = 2.5;  // reach across a ray, in spacings
constexpr double least_cosine = 0.05;
constexpr double free_margin = 1.5;  // before this many truncations from its end a ray is free
constexpr double behind_cells = 2;  // of the rays' grid, behind the surface: where they are counted
constexpr double same_side = 0.5;   // cosine between normals of one side of an edge or a wall
constexpr double normal_tolerance2 = 0.64;  // as in moving least squares
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

struct Ray {
  Eigen::Vector3d to_scanner;  // unit
  double truncation = 0;
  double reach = 0;   // across
  double weight = 0;  // cosine of incidence over variance
};

// The samples' rays, in the unit cube. `samples` are sorted and merged, so each looks up its point.
std::vector<Ray> rays_of(const Samples& samples, const PointCloud& cloud,
                         std::span<const Eigen::Vector3d> viewpoints,
                         const RangeFusionOptions& options, std::vector<Eigen::Vector3d>& from) {
  const KdTree points(cloud.points);
  std::vector<Ray> rays(samples.points.size());
  from.resize(rays.size());
  parallel_for(rays.size(), [&](std::size_t i) {
    const std::uint32_t at =
        points.nearest(samples.box.to_world(samples.points[i]), unlimited_m)->index;
    from[i] = samples.box.to_unit(viewpoints[at]);
    if (!from[i].allFinite()) return;
    Ray& ray = rays[i];
    ray.to_scanner = (from[i] - samples.points[i]).normalized();
    const double spacing = std::sqrt(samples.area[i]);
    const double sigma = cloud.sigma_m.empty() ? 0 : cloud.sigma_m[at] / samples.box.side_m;
    ray.reach = beside * spacing;
    ray.truncation =
        std::max(options.truncation_spacings * spacing, options.truncation_sigmas * sigma);
    const double cosine = std::max(least_cosine, ray.to_scanner.dot(samples.normals[i]));
    ray.weight = sigma > 0 ? cosine / (sigma * sigma) : cosine / samples.area[i];
  });
  return rays;
}

class FusedField {
 public:
  FusedField(const Samples& samples, const std::vector<Ray>& rays, const RayBricks& free)
      : samples_(samples), rays_(rays), free_(free), tree_(samples.points) {
    for (const Ray& ray : rays) widest_ = std::max(widest_, std::hypot(ray.reach, ray.truncation));
  }

  double value(const Eigen::Vector3d& x) const {
    thread_local std::vector<Neighbour> found;
    thread_local std::vector<Say> says;
    const Ray& nearest = rays_[tree_.nearest(x, unlimited_m)->index];
    // Truncations are alike among neighbours; those of far ones must not make the search slow.
    tree_.within(x, std::min(widest_, 1.5 * std::hypot(nearest.reach, nearest.truncation)), found);
    collect(x, found, says);
    if (says.empty()) return unknown;
    const Eigen::Vector3d normal = normal_of(says);
    double sum = 0, weights = 0, truncation = 0;
    for (const Say& say : says) {
      const Eigen::Vector3d& own = samples_.normals[say.sample];
      const double weight =
          say.weight * std::exp(-(own - normal).squaredNorm() / normal_tolerance2);
      // Between the tangent planes at the sample and here: exact on spheres.
      sum += weight * (x - samples_.points[say.sample]).dot((own + normal).normalized());
      weights += weight;
      truncation = std::max(truncation, rays_[say.sample].truncation);
    }
    if (!(weights > 0)) return unknown;
    // Rays that come out behind the surface have passed through it and speak as loudly as those
    // that end there. These were counted over the disc of their reach, whose weight (1 - t^2)^2 has
    // the mean 1/3; those over the cross-section of a cell.
    const double cell = std::sqrt(free_.cell_area());
    const Eigen::Vector3d behind = x - (sum / weights + behind_cells * cell) * normal;
    const double disc = std::numbers::pi / 3 * nearest.reach * nearest.reach;
    const double passing = std::max(0.0, free_.rays_through(behind, normal)) * disc /
                           free_.cell_area() * nearest.weight;
    return (sum + passing * truncation) / (weights + passing);
  }

 private:
  // What a sample has to say of a place.
  struct Say {
    std::uint32_t sample;
    double weight, distance2;
  };

  void collect(const Eigen::Vector3d& x, const std::vector<Neighbour>& found,
               std::vector<Say>& says) const {
    says.clear();
    for (const Neighbour& n : found) {
      const Ray& ray = rays_[n.index];
      if (!(ray.weight > 0)) continue;
      const Eigen::Vector3d offset = x - samples_.points[n.index];
      const double along = offset.dot(ray.to_scanner);
      const double across2 = offset.squaredNorm() - along * along;
      if (std::abs(along) > ray.truncation || across2 > ray.reach * ray.reach) continue;
      const double t = 1 - across2 / (ray.reach * ray.reach);
      const double s = 1 - along * along / (ray.truncation * ray.truncation);
      says.push_back({n.index, ray.weight * t * t * s, n.distance2_m2});
    }
  }

  // The mean normal of the samples that face as the nearest one does.
  Eigen::Vector3d normal_of(const std::vector<Say>& says) const {
    const auto nearest = std::min_element(says.begin(), says.end(), [](const Say& a, const Say& b) {
      return std::tie(a.distance2, a.sample) < std::tie(b.distance2, b.sample);
    });
    const Eigen::Vector3d& first = samples_.normals[nearest->sample];
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Say& say : says)
      if (const Eigen::Vector3d& n = samples_.normals[say.sample]; n.dot(first) > same_side)
        sum += say.weight * n;
    return sum.normalized();
  }

  const Samples& samples_;
  const std::vector<Ray>& rays_;
  const RayBricks& free_;
  KdTree tree_;
  double widest_ = 0;
};

double typical_spacing(const Samples& samples) {
  std::vector<double> areas = samples.area;
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return std::sqrt(*middle);
}

// The part of a ray within the unit cube, from `to` backwards.
Eigen::Vector3d cut_at_cube(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  double share = 1;
  for (int a = 0; a < 3; ++a) {
    const double step = from[a] - to[a];
    if (to[a] + step > 1) share = std::min(share, (1 - to[a]) / step);
    if (to[a] + step < 0) share = std::min(share, -to[a] / step);
  }
  return to + std::max(0.0, share) * (from - to);
}

void require(bool fulfilled, const char* field, double value, const char* limit) {
  if (!fulfilled)
    throw Error(Trouble::usage, std::string("range-fusion: ") + field + " is " + shortest(value) +
                                    ", limit " + limit);
}

}  // namespace

void check(const RangeFusionOptions& options) {
  require(options.cell_spacings > 0 && options.cell_spacings <= 100, "cell_spacings",
          options.cell_spacings, "above 0 to 100");
  require(options.truncation_spacings > 0 && options.truncation_spacings <= 100,
          "truncation_spacings", options.truncation_spacings, "above 0 to 100");
  require(options.truncation_sigmas >= 0 && options.truncation_sigmas <= 100, "truncation_sigmas",
          options.truncation_sigmas, "0 to 100");
  require(options.max_depth >= 3 && options.max_depth <= 20, "max_depth", options.max_depth,
          "3 to 20");
}

SurfaceResult range_fusion(const PointCloud& cloud, std::span<const Eigen::Vector3d> viewpoints,
                           const RangeFusionOptions& options, const Progress& progress) {
  check(options);
  const Stopwatch watch;
  if (viewpoints.size() != cloud.size() || viewpoints.empty())
    throw Error(Trouble::input, "range-fusion: the places of the scanners are not known",
                "give it the scans and their poses, without --thin, or choose another method");
  const Samples samples = prepare_samples(cloud);
  const double cell = options.cell_spacings * typical_spacing(samples);
  const int depth = static_cast<int>(
      std::clamp(std::ceil(-std::log2(cell)), 3.0, static_cast<double>(options.max_depth)));
  if (progress) progress("rays", 0);
  std::vector<Eigen::Vector3d> from;
  const std::vector<Ray> rays = rays_of(samples, cloud, viewpoints, options, from);
  RayBricks free(samples.points, depth - 1);  // a finer cell sees too few rays
  parallel_for(rays.size(), [&](std::size_t i) {
    if (!(rays[i].weight > 0)) return;
    const double margin = free_margin * rays[i].truncation;
    const Eigen::Vector3d end = samples.points[i] + margin * rays[i].to_scanner;
    if ((from[i] - samples.points[i]).norm() > margin) free.count(cut_at_cube(from[i], end), end);
  });
  if (progress) progress("surface", 0);
  const FusedField field(samples, rays, free);
  SurfaceResult result =
      world_surface(followed_surface(samples.points, depth,
                                     [&](const Eigen::Vector3d& u) { return field.value(u); }),
                    samples, "range-fusion");
  result.finest_cell_m = samples.box.side_m / (1 << depth);
  result.unknowns = samples.points.size();
  result.stop = SolveStop::direct;
  result.cost.seconds = watch.seconds();
  if (progress) progress("surface", 1);
  return result;
}

}  // namespace scan
