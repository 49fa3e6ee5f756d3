// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/median.h"
#include "libscan/reconstruct/isosurface.h"
#include "libscan/reconstruct/local_smoothing.h"
#include "libscan/reconstruct/ssd_fit.h"
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
                std::string("ssd: ") + field + " is " + std::to_string(value) + ", limit " + limit);
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
  for (auto& vertex : result.surface.vertices) vertex = samples.box.to_world(vertex);
  return result;
}

std::size_t active_functions(const OctreeGrid& grid) {
  std::size_t count = 0;
  for (const BlockLevel& level : grid.levels) count += level.active * block_size;
  return count;
}

}  // namespace

void check(const SsdOptions& options) {
  require(options.depth >= 3 && options.depth <= 12, "depth", options.depth, "3 to 12");
  require(is_length(options.sigma_m), "sigma_m", options.sigma_m, "at least 0");
  require(is_length(options.smoothing_length_m), "smoothing_length_m", options.smoothing_length_m,
          "at least 0");
  require(options.relative_residual >= 0 && options.relative_residual < 1, "relative_residual",
          options.relative_residual, "0 to below 1");
  require(options.max_iterations > 0, "max_iterations", options.max_iterations, "above 0");
}

SurfaceResult ssd(const PointCloud& cloud, const SsdOptions& options, const Progress& progress) {
  check(options);
  const Stopwatch watch;
  const Samples samples = prepare_samples(cloud, options.sigma_m);
  const int complete_depth = std::min(most_complete_depth, options.depth);
  const std::vector<int> depths = sample_depths(samples, complete_depth, options.depth);
  if (progress) progress("octree", 0);
  const OctreeGrid grid = make_octree_grid(samples.points, depths, complete_depth);
  const SsdFit fit = fit_surface(grid, samples,
                                 {.length = options.smoothing_length_m / samples.box.side_m,
                                  .relative_residual = options.relative_residual,
                                  .max_iterations = options.max_iterations},
                                 progress);
  if (progress) progress("surface", 0);
  // One level below the solution, where the depth allows it: smaller facets on the same function.
  const int surface_depth = std::min(options.depth, grid.finest_depth() + 1);
  SurfaceResult result = world_result(
      zero_level_set({grid, fit.solution.coefficients}, surface_depth), samples, fit.length);
  result.finest_cell_m = samples.box.side_m / (1 << surface_depth);
  result.depth = grid.finest_depth();
  result.sigma_m = samples.box.side_m * median(samples.sigma);
  result.smoothing_length_m = samples.box.side_m * median(fit.length);
  result.unknowns = active_functions(grid);
  result.iterations = fit.solution.iterations;
  result.relative_residual = fit.solution.relative_residual;
  result.stop = fit.solution.stop;
  result.invalid_points = samples.invalid_points;
  result.outlying_points = samples.outlying_points;
  result.cost.seconds = watch.seconds();
  if (progress) progress("surface", 1);
  return result;
}

}  // namespace scan
