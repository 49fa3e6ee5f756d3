// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/range_fusion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/followed_surface.h"
#include "libscan/reconstruct/ray_bricks.h"
#include "libscan/reconstruct/world_surface.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr double beside = 2.5;  // reach across a ray, in spacings
constexpr double least_cosine = 0.05;
constexpr double free_margin = 1.5;  // before this many truncations from its end a ray is free
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
    const Ray& nearest = rays_[tree_.nearest(x, unlimited_m)->index];
    // Truncations are alike among neighbours; those of far ones must not make the search slow.
    tree_.within(x, std::min(widest_, 1.5 * std::hypot(nearest.reach, nearest.truncation)), found);
    double sum = 0, weights = 0, truncation = 0;
    for (const Neighbour& n : found) {
      const Ray& ray = rays_[n.index];
      if (!(ray.weight > 0)) continue;
      const Eigen::Vector3d offset = x - samples_.points[n.index];
      const double along = offset.dot(ray.to_scanner);
      const double across2 = offset.squaredNorm() - along * along;
      if (std::abs(along) > ray.truncation || across2 > ray.reach * ray.reach) continue;
      const double t = 1 - across2 / (ray.reach * ray.reach);
      const double s = 1 - along * along / (ray.truncation * ray.truncation);
      const double weight = ray.weight * t * t * s;
      sum += weight * offset.dot(samples_.normals[n.index]);
      weights += weight;
      truncation = std::max(truncation, ray.truncation);
    }
    if (!(weights > 0)) return unknown;
    // A ray that passes speaks as loudly as one that ends here. Those were counted over the disc of
    // their reach, whose weight (1 - t^2)^2 has the mean 1/3; these over the cross-section of a
    // cell.
    const double disc = std::numbers::pi / 3 * nearest.reach * nearest.reach;
    const double passing = free_.mean_rays_about(x) * disc / free_.cell_area() * nearest.weight;
    return (sum + passing * truncation) / (weights + passing);
  }

 private:
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
    throw Error(Trouble::usage, std::string("range-fusion: ") + field + " is " +
                                    std::to_string(value) + ", limit " + limit);
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
      std::clamp(std::floor(-std::log2(cell)), 3.0, static_cast<double>(options.max_depth)));
  if (progress) progress("rays", 0);
  std::vector<Eigen::Vector3d> from;
  const std::vector<Ray> rays = rays_of(samples, cloud, viewpoints, options, from);
  RayBricks free(samples.points, depth);
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
