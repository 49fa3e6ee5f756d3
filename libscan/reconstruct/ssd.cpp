// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/median.h"
#include "libscan/core/parallel.h"
#include "libscan/core/shortest.h"
#include "libscan/reconstruct/bilateral_samples.h"
#include "libscan/reconstruct/isosurface.h"
#include "libscan/reconstruct/local_smoothing.h"
#include "libscan/reconstruct/ssd_parts.h"
#include "libscan/reconstruct/support.h"
#include "libscan/search/batch.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr int most_complete_depth = 4;  // levels to this one are whole
constexpr double least_support = 1e-3;  // of the data's area, for a component to stay

void require(bool fulfilled, const char* field, double value, const char* limit) {
  if (!fulfilled)
    throw Error(Trouble::usage,
                std::string("ssd: ") + field + " is " + shortest(value) + ", limit " + limit);
}

bool is_length(double x) {
  return x >= 0 && std::isfinite(x);
}

// Of each vertex, from the sample next to it.
void add_support(const Samples& samples, const std::vector<double>& length, SurfaceResult& result) {
  const KdTree tree(samples.points);
  const auto& vertices = result.surface.vertices;
  std::vector<Neighbour> nearest;
  nearest_of_each(tree, vertices, unlimited_m, curve_order(vertices), nearest);
  for (const Neighbour& n : nearest) {
    result.support_m.push_back(samples.box.side_m * std::sqrt(n.distance2_m2));
    result.vertex_smoothing_m.push_back(samples.box.side_m * length[n.index]);
    result.standard_error_m.push_back(
        samples.box.side_m * samples.sigma[n.index] *
        std::sqrt(posterior_variance(samples.area[n.index], length[n.index])));
  }
}

SurfaceResult world_result(Mesh mesh, const Samples& samples, const std::vector<double>& length) {
  if (mesh.empty())
    throw Error(Trouble::computation, "ssd: no surface crosses the box",
                "check that the normals are oriented consistently");
  SurfaceResult result;
  result.surface = supported_components(mesh, samples.points, samples.area, least_support);
  mesh = {};
  add_support(samples, length, result);
  result.cells_from_m = samples.box.origin_m;
  for (auto& vertex : result.surface.vertices) vertex = samples.box.to_world(vertex);
  return result;
}

std::size_t active_functions(const OctreeGrid& grid) {
  std::size_t count = 0;
  for (const BlockLevel& level : grid.levels) count += level.active * block_size;
  return count;
}

// One level below the solution, where the depth allows it: smaller facets on the same function.
int surface_depth(int finest, const SsdOptions& options) {
  return std::min(options.depth, finest + 1);
}

// A function and its cells.
struct Solved {
  OctreeGrid grid;
  SsdFit fit;
};

Solved solved(const SsdProblem& problem, const SsdFitOptions& options, const Progress& progress) {
  Solved result{make_octree_grid(problem.samples.points, problem.depths, problem.complete_depth),
                {}};
  result.fit = fit_surface(result.grid, problem.samples, options, progress);
  return result;
}

// Newton's steps to the surface: f is a distance to first order only, and a sample a spacing off
// would be told 5 % too far. One that does not bring f nearer to 0 is not made, as between sheets
// that the fit has merged; for their sake the normal is that at the sample.
constexpr int most_steps = 3;

FittedSamples at_samples(const Samples& samples, const Solved& solved) {
  FittedSamples fitted{samples.points, samples.normals, solved.fit.length, solved.fit.trust};
  const SplineField field{solved.grid, solved.fit.solution.coefficients};
  parallel_for(samples.points.size(), [&](std::size_t i) {
    FieldValue f = evaluate(field, samples.points[i]);
    for (int step = 0; step < most_steps && f.gradient.norm() > 0; ++step) {
      if (step == 0) fitted.normals[i] = f.gradient.normalized();
      const Eigen::Vector3d next = fitted.feet[i] - f.value / f.gradient.squaredNorm() * f.gradient;
      const FieldValue there = evaluate(field, next);
      if (step > 0 && std::abs(there.value) > std::abs(f.value) / 2) return;
      fitted.feet[i] = next;
      f = there;
    }
  });
  return fitted;
}

// Once more, through samples moved up to creases, if any are. The lengths stay.
std::optional<Samples> solve_up_to_creases(const SsdProblem& problem, const SsdFitOptions& options,
                                           Solved& all, const Progress& progress) {
  std::optional<Samples> moved =
      bilateral_samples(problem.samples, at_samples(problem.samples, all));
  if (!moved) return moved;
  std::vector<double> length = std::move(all.fit.length);
  all = {};
  all = solved({*moved, problem.depths, problem.complete_depth, problem.surface_depth}, options,
               progress);
  all.fit.length = std::move(length);
  return moved;
}

SurfaceResult surface_of(const Solved& all, const Samples& samples, const SsdOptions& options) {
  const int depth = surface_depth(all.grid.finest_depth(), options);
  return world_result(zero_level_set({all.grid, all.fit.solution.coefficients}, depth), samples,
                      all.fit.length);
}

// Unsupported surface far from all data may be a bubble that nothing asks for: where f has the
// wrong sign there, it is drawn to the right one.
void draw_to_right_sides(Solved& all, const Samples& fitted, const Samples& samples,
                         const SsdFitOptions& fit_options, const SsdOptions& options,
                         SurfaceResult& result) {
  constexpr int most_rounds = 3;
  FarPlaces far;
  for (int round = 0; round < most_rounds; ++round) {
    const auto farthest = std::max_element(result.support_m.begin(), result.support_m.end());
    if (farthest == result.support_m.end() || *farthest <= far_distance * samples.box.side_m)
      return;
    const FarPlaces more = misjudged_places({all.grid, all.fit.solution.coefficients}, fitted);
    if (more.places.empty()) return;
    far.places.insert(far.places.end(), more.places.begin(), more.places.end());
    far.distances.insert(far.distances.end(), more.distances.begin(), more.distances.end());
    fit_again(all.grid, fitted, far, fit_options, all.fit);
    result = surface_of(all, samples, options);
  }
}

SurfaceResult at_once(const SsdProblem& problem, const SsdFitOptions& fit_options,
                      const SsdOptions& options, std::optional<Samples>* moved,
                      const Progress& progress) {
  Solved all = solved(problem, fit_options, progress);
  if (moved) *moved = solve_up_to_creases(problem, fit_options, all, progress);
  if (progress) progress("surface", 0);
  SurfaceResult result = surface_of(all, problem.samples, options);
  draw_to_right_sides(all, moved && *moved ? **moved : problem.samples, problem.samples,
                      fit_options, options, result);
  const auto& [grid, fit] = all;
  result.depth = grid.finest_depth();
  result.smoothing_length_m = median(fit.length);
  result.unknowns = active_functions(grid);
  result.iterations = fit.solution.iterations;
  result.relative_residual = fit.solution.relative_residual;
  result.stop = fit.solution.stop;
  return result;
}

SurfaceResult in_parts(const SsdProblem& problem, int split, const SsdFitOptions& fit_options,
                       const SsdOptions& options, const Progress& progress) {
  const SsdParts parts = fit_parts(problem, fit_options, split, progress);
  if (progress) progress("surface", 0);
  const int depth = surface_depth(parts.finest_depth, options);
  SurfaceResult result =
      world_result(zero_level_set(parts.field(), depth), problem.samples, parts.length);
  const double side_m = problem.samples.box.side_m;
  const SeamDeviation seams = seam_deviation(parts, problem.samples);
  result.parts = {.parts_per_axis = std::size_t{1} << split,
                  .seam_rms_m = side_m * seams.rms,
                  .seam_largest_m = side_m * seams.largest,
                  .seam_points = seams.samples};
  result.depth = parts.finest_depth;
  result.smoothing_length_m = median(parts.length);
  result.unknowns = parts.unknowns;
  result.iterations = parts.iterations;
  result.relative_residual = parts.relative_residual;
  result.stop = parts.stop;
  return result;
}

SurfaceResult surface_through(const Samples& samples, const SsdOptions& options,
                              std::optional<Samples>* moved, const Progress& progress) {
  const Stopwatch watch;
  const int complete_depth = std::min(most_complete_depth, options.depth);
  const std::vector<int> depths = sample_depths(samples, complete_depth, options.depth);
  if (progress) progress("octree", 0);
  const int finest = std::max(complete_depth, *std::max_element(depths.begin(), depths.end()));
  const SsdProblem problem{samples, depths, complete_depth, surface_depth(finest, options)};
  const SsdFitOptions fit_options{.length = options.smoothing_length_m / samples.box.side_m,
                                  .relative_residual = options.relative_residual,
                                  .max_iterations = options.max_iterations};
  const int split = needed_split(problem, options.memory_gib);
  SurfaceResult result = split == 0 ? at_once(problem, fit_options, options, moved, progress)
                                    : in_parts(problem, split, fit_options, options, progress);
  result.finest_cell_m = samples.box.side_m / (1 << surface_depth(result.depth, options));
  result.sigma_m = samples.box.side_m * median(samples.sigma);
  result.smoothing_length_m *= samples.box.side_m;
  result.invalid_points = samples.invalid_points;
  result.outlying_points = samples.outlying_points;
  result.cost.seconds = watch.seconds();
  if (progress) progress("surface", 1);
  return result;
}

}  // namespace

void check(const SsdOptions& options) {
  require(options.depth >= 3 && options.depth <= 12, "depth", options.depth, "3 to 12");
  require(is_length(options.sigma_m), "sigma_m", options.sigma_m, "at least 0");
  require(is_length(options.smoothing_length_m), "smoothing_length_m", options.smoothing_length_m,
          "at least 0");
  require(options.relative_residual >= 0 && options.relative_residual < 1, "relative_residual",
          options.relative_residual, "0 to below 1");
  require(options.memory_gib > 0 && std::isfinite(options.memory_gib), "memory_gib",
          options.memory_gib, "above 0");
  require(options.max_iterations > 0, "max_iterations", options.max_iterations, "above 0");
}

SurfaceResult ssd(const PointCloud& cloud, const SsdOptions& options, const Progress& progress) {
  check(options);
  return surface_through(prepare_samples(cloud, options.sigma_m), options, nullptr, progress);
}

SurfaceResult ssd_up_to_creases(PointCloud& cloud, std::vector<double>& spacing_m,
                                const SsdOptions& options, const Progress& progress) {
  check(options);
  std::optional<Samples> moved;
  SurfaceResult result =
      surface_through(prepare_samples(cloud, options.sigma_m), options, &moved, progress);
  if (!moved) return result;
  result.moved_points = moved->points.size();
  cloud = {};
  spacing_m.clear();
  for (std::size_t i = 0; i < moved->points.size(); ++i) {
    cloud.points.push_back(moved->box.to_world(moved->points[i]));
    spacing_m.push_back(moved->box.side_m * std::sqrt(moved->area[i]));
  }
  cloud.normals = std::move(moved->normals);
  return result;
}

}  // namespace scan
