// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "libscan/core/error.h"
#include "libscan/reconstruct/isosurface.h"
#include "libscan/reconstruct/ssd_solver.h"
#include "libscan/reconstruct/support.h"

namespace scan {
namespace {

constexpr int most_complete_depth = 4;  // levels to this one are whole
constexpr double least_support = 1e-3;  // of the data's area, for a component to stay

void require(bool fulfilled, const char* field, double value, const char* limit) {
  if (!fulfilled)
    throw Error(Trouble::usage,
                std::string("ssd: ") + field + " is " + std::to_string(value) + ", limit " + limit);
}

bool is_positive(double x) {
  return x > 0 && std::isfinite(x);
}

SurfaceResult world_result(Mesh mesh, const Samples& samples) {
  if (mesh.empty())
    throw Error(Trouble::computation, "ssd: no surface crosses the box",
                "check that the normals are oriented consistently");
  mesh = supported_components(mesh, samples.points, samples.area, least_support);
  SurfaceResult result;
  result.support_m = distance_to_points(mesh, samples.points);
  for (double& support : result.support_m) support *= samples.box.side_m;
  for (auto& vertex : mesh.vertices) vertex = samples.box.to_world(vertex);
  result.surface = std::move(mesh);
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
  require(is_positive(options.samples_per_cell), "samples_per_cell", options.samples_per_cell,
          "above 0");
  require(is_positive(options.value_weight), "value_weight", options.value_weight, "above 0");
  require(is_positive(options.gradient_weight), "gradient_weight", options.gradient_weight,
          "above 0");
  require(is_positive(options.smoothness_weight), "smoothness_weight", options.smoothness_weight,
          "above 0");
  require(options.relative_residual > 0 && options.relative_residual < 1, "relative_residual",
          options.relative_residual, "between 0 and 1");
  require(options.max_iterations > 0, "max_iterations", options.max_iterations, "above 0");
}

SurfaceResult ssd(const PointCloud& cloud, const SsdOptions& options, const Progress& progress) {
  check(options);
  const Stopwatch watch;
  const Samples samples = prepare_samples(cloud);
  const int complete_depth = std::min(most_complete_depth, options.depth);
  const std::vector<int> depths =
      sample_depths(samples, options.samples_per_cell, complete_depth, options.depth);
  if (progress) progress("octree", 0);
  const OctreeGrid grid = make_octree_grid(samples.points, depths, complete_depth);
  SsdSystem system(grid, samples,
                   {options.value_weight, options.gradient_weight, options.smoothness_weight});
  const SsdSolution solution =
      solve(system, grid, options.relative_residual, options.max_iterations, progress);
  if (progress) progress("surface", 0);
  // One level below the solution, where the depth allows it: smaller facets on the same function.
  const int surface_depth = std::min(options.depth, grid.finest_depth() + 1);
  SurfaceResult result =
      world_result(zero_level_set({grid, solution.coefficients}, surface_depth), samples);
  result.finest_cell_m = samples.box.side_m / (1 << surface_depth);
  result.unknowns = active_functions(grid);
  result.iterations = solution.iterations;
  result.relative_residual = solution.relative_residual;
  result.stop = solution.stop;
  result.invalid_points = samples.invalid_points;
  result.outlying_points = samples.outlying_points;
  result.cost.seconds = watch.seconds();
  if (progress) progress("surface", 1);
  return result;
}

}  // namespace scan
