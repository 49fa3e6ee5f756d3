// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr double around_share = 2 * blended_share;  // of a part's side: samples seen beside it
constexpr std::size_t most_thinned = 10000, least_step = 10;
constexpr int most_split = 5;
constexpr double least_blended_cells = 4;
constexpr double gib = 1073741824.0;
// Bytes. Of a fit: the coarsest level's matrix, dense over 10^3 functions, its factor, and about as
// much for the cells and blocks of the levels next to it; unknowns, work vectors, tables and
// factors by block; terms by sample.
constexpr double fit_always = 3 * 1e6 * sizeof(double), fit_per_block = 1300, fit_per_sample = 200;
// Of each sample to the end: itself, its depth, length and parts, and a search tree of all.
constexpr double stay_per_sample = 100;
// While the samples are made.
constexpr double prepare_per_sample = 400;
// What a part leaves behind of a block: coefficients and key.
constexpr double left_per_block = sizeof(double) * block_size + sizeof(std::uint64_t);
// Of the mesh while it is made: a crossed cell twice and the triangles twice, for each vertex.
constexpr double mesh_per_vertex = 220;

// Some of the samples, with their depths.
struct Selection {
  Samples samples;
  std::vector<int> depths;
  std::vector<std::uint32_t> index;  // in the whole cloud

  void add(const SsdProblem& problem, std::size_t i, double area, int depth) {
    samples.points.push_back(problem.samples.points[i]);
    samples.normals.push_back(problem.samples.normals[i]);
    samples.area.push_back(area);
    samples.sigma.push_back(problem.samples.sigma[i]);
    depths.push_back(depth);
    index.push_back(static_cast<std::uint32_t>(i));
  }
};

// Every `step`-th sample of the cloud, standing for `step` of them.
struct Thinned {
  std::size_t step;
  Selection all;
};

Thinned thinned(const SsdProblem& problem) {
  const std::size_t count = problem.samples.points.size();
  Thinned result{std::max(least_step, (count + most_thinned - 1) / most_thinned), {}};
  Selection& all = result.all;
  for (std::size_t i = 0; i < count; i += result.step)
    all.add(problem, i, problem.samples.area[i] * static_cast<double>(result.step), 0);
  all.depths = sample_depths(all.samples, problem.complete_depth,
                             *std::max_element(problem.depths.begin(), problem.depths.end()));
  for (std::size_t k = 0; k < all.depths.size(); ++k)
    all.depths[k] = std::min(all.depths[k], problem.depths[all.index[k]]);
  return result;
}

Eigen::AlignedBox3d part_box(std::uint32_t part, int split, double grown_share) {
  const std::uint32_t mask = (1u << split) - 1;
  const Eigen::Vector3d low(part & mask, part >> split & mask, part >> (2 * split));
  const Eigen::Vector3d grown = Eigen::Vector3d::Constant(grown_share);
  const double side = std::ldexp(1.0, -split);
  return {side * (low - grown), side * (low + Eigen::Vector3d::Ones() + grown)};
}

// Of each part, the samples in and around it.
std::vector<std::vector<std::uint32_t>> samples_of_parts(const SsdProblem& problem, int split) {
  std::vector<std::vector<std::uint32_t>> of_parts(std::size_t{1} << (3 * split));
  const int parts = 1 << split;
  for (std::uint32_t i = 0; i < problem.samples.points.size(); ++i) {
    int low[3], high[3];
    for (int a = 0; a < 3; ++a) {
      const double x = problem.samples.points[i][a] * parts;
      low[a] = std::clamp(static_cast<int>(std::floor(x - around_share)), 0, parts - 1);
      high[a] = std::clamp(static_cast<int>(std::floor(x + around_share)), 0, parts - 1);
    }
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x)
          of_parts[static_cast<std::size_t>(x + ((y + (z << split)) << split))].push_back(i);
  }
  return of_parts;
}

// The chosen samples, and of the others the thinned ones.
Selection selected(const SsdProblem& problem, std::span<const std::uint32_t> chosen,
                   const Thinned& rest) {
  Selection part;
  auto next = chosen.begin();
  const auto add_until = [&](std::size_t end) {
    for (; next != chosen.end() && *next < end; ++next)
      part.add(problem, *next, problem.samples.area[*next], problem.depths[*next]);
  };
  for (std::size_t k = 0; k < rest.all.index.size(); ++k) {
    const std::uint32_t i = rest.all.index[k];
    add_until(i);
    if (next == chosen.end() || *next != i)
      part.add(problem, i, rest.all.samples.area[k], rest.all.depths[k]);
  }
  add_until(problem.samples.points.size());
  part.samples.box = problem.samples.box;
  part.samples.scattered_all_around = problem.samples.scattered_all_around;
  return part;
}

// Leaves what evaluating the field in and beside a part needs.
void keep_part(const Eigen::AlignedBox3d& box, OctreeGrid& grid, LevelArrays& coefficients) {
  for (std::size_t l = 0; l < grid.levels.size(); ++l) {
    BlockLevel& level = grid.levels[l];
    BlockLevel kept;
    kept.depth = level.depth;
    std::vector<double> values;
    for (std::size_t b = 0; b < level.active; ++b) {
      if (!reaches(level.blocks[b], level.depth, box)) continue;
      kept.keys.push_back(level.keys[b]);
      const auto begin = coefficients[l].begin() + static_cast<std::ptrdiff_t>(b * block_size);
      values.insert(values.end(), begin, begin + block_size);
    }
    kept.active = kept.keys.size();
    kept.keys.shrink_to_fit();
    values.shrink_to_fit();
    level = std::move(kept);
    coefficients[l] = std::move(values);
  }
}

std::size_t active_functions(const OctreeGrid& grid) {
  std::size_t count = 0;
  for (const BlockLevel& level : grid.levels) count += level.active * block_size;
  return count;
}

struct FitForecast {
  double fit_gib, left_gib;  // while it runs; of what reaches the box
};

FitForecast forecast_fit(const SsdProblem& problem, const Eigen::AlignedBox3d& box,
                         double enough_gib) {
  const double count = static_cast<double>(problem.samples.points.size());
  const double without_blocks = (fit_always + fit_per_sample * count) / gib;
  const double enough_blocks = (enough_gib - without_blocks) * gib / fit_per_block;
  const BlockCount blocks = octree_blocks(problem.samples.points, problem.depths,
                                          problem.complete_depth, box, enough_blocks);
  return {without_blocks + fit_per_block / gib * static_cast<double>(blocks.all),
          left_per_block / gib * static_cast<double>(blocks.reaching)};
}

// A surface that lies any way crosses the edges of cells 3/2 times per area of a face: the mean of
// |x| + |y| + |z| over unit vectors. Each crossing is a vertex.
double mesh_gib(const SsdProblem& problem) {
  const auto& area = problem.samples.area;
  const double total = std::accumulate(area.begin(), area.end(), 0.0);
  return mesh_per_vertex / gib * 1.5 * std::ldexp(total, 2 * problem.surface_depth);
}

// Fits the selected samples and returns the smoothing length at each.
std::vector<double> add_field(const Selection& part, int complete_depth,
                              const SsdFitOptions& options, SsdParts& result) {
  OctreeGrid grid = make_octree_grid(part.samples.points, part.depths, complete_depth);
  SsdFit fit = fit_surface(grid, part.samples, options);
  result.iterations += fit.solution.iterations;
  result.relative_residual = std::max(result.relative_residual, fit.solution.relative_residual);
  if (fit.solution.stop != SolveStop::converged) result.stop = fit.solution.stop;
  result.finest_depth = std::max(result.finest_depth, grid.finest_depth());
  result.unknowns += active_functions(grid);
  result.grids.push_back(std::move(grid));
  result.coefficients.push_back(std::move(fit.solution.coefficients));
  return std::move(fit.length);
}

}  // namespace

double forecast_gib(const SsdProblem& problem, double enough_gib) {
  const double count = static_cast<double>(problem.samples.points.size());
  return std::max(prepare_per_sample / gib * count,
                  stay_per_sample / gib * count + forecast_fit(problem, {}, enough_gib).fit_gib);
}

double forecast_in_parts_gib(const SsdProblem& problem, int split, double enough_gib) {
  const Thinned rest = thinned(problem);
  const double count = static_cast<double>(problem.samples.points.size());
  double stay_gib = stay_per_sample / gib * count, largest_gib = mesh_gib(problem);
  std::uint32_t part = 0;
  for (const auto& chosen : samples_of_parts(problem, split)) {
    const Eigen::AlignedBox3d box = part_box(part++, split, blended_share);
    if (chosen.empty()) continue;
    const Selection near = selected(problem, chosen, rest);
    const FitForecast of_part =
        forecast_fit({near.samples, near.depths, problem.complete_depth, problem.surface_depth},
                     box, enough_gib);
    largest_gib = std::max(largest_gib, of_part.fit_gib);
    stay_gib += of_part.left_gib;
    if (stay_gib + largest_gib > enough_gib) break;
  }
  return std::max(prepare_per_sample / gib * count, stay_gib + largest_gib);
}

int needed_split(const SsdProblem& problem, double limit_gib) {
  if (forecast_gib(problem, limit_gib) <= limit_gib) return 0;
  const int finest = *std::max_element(problem.depths.begin(), problem.depths.end());
  for (int split = 1; split <= most_split; ++split) {
    if (std::ldexp(blended_share, finest - split) < least_blended_cells) break;
    if (forecast_in_parts_gib(problem, split, limit_gib) <= limit_gib) return split;
  }
  throw Error(Trouble::resource,
              "ssd: needs more than " + std::to_string(limit_gib) + " GiB even in parts",
              "use a smaller depth, thin the points or allow more memory");
}

BlendedField SsdParts::field() const {
  BlendedField field{split, {}, field_of_part};
  for (std::size_t f = 0; f < grids.size(); ++f)
    field.fields.push_back({grids[f], coefficients[f]});
  return field;
}

SsdParts fit_parts(const SsdProblem& problem, const SsdFitOptions& options, int split,
                   const Progress& progress) {
  const SsdFitOptions chosen_options = chosen_for(problem.samples, options);
  const Thinned rest = thinned(problem);
  const auto of_parts = samples_of_parts(problem, split);
  SsdParts result{.split = split};
  result.length.assign(problem.samples.points.size(), 0.0);
  const Selection far = selected(problem, {}, rest);
  add_field(far, problem.complete_depth, chosen_options, result);
  for (std::uint32_t part = 0; part < of_parts.size(); ++part) {
    if (progress)
      progress("solve", static_cast<double>(part) / static_cast<double>(of_parts.size()));
    result.field_of_part.push_back(0);
    if (of_parts[part].empty()) continue;
    result.field_of_part.back() = static_cast<std::uint32_t>(result.grids.size());
    const Selection near = selected(problem, of_parts[part], rest);
    const std::vector<double> length =
        add_field(near, problem.complete_depth, chosen_options, result);
    keep_part(part_box(part, split, blended_share), result.grids.back(),
              result.coefficients.back());
    const Eigen::AlignedBox3d own = part_box(part, split, 0);
    for (std::size_t k = 0; k < length.size(); ++k)
      if (own.contains(near.samples.points[k])) result.length[near.index[k]] = length[k];
  }
  return result;
}

SeamDeviation seam_deviation(const SsdParts& parts, const Samples& samples) {
  const BlendedField field = parts.field();
  std::vector<double> deviations(samples.points.size(), -1.0);
  parallel_for(samples.points.size(), [&](std::size_t i) {
    const PartShares shares = shares_at(samples.points[i], parts.split);
    if (shares.count < 2) return;
    double low = 0, high = 0;
    for (int k = 0; k < shares.count; ++k) {
      const FieldValue f =
          evaluate(field.fields[field.field_of_part[shares.parts[k].part]], samples.points[i]);
      const double distance = f.value / f.gradient.norm();
      low = k == 0 ? distance : std::min(low, distance);
      high = k == 0 ? distance : std::max(high, distance);
    }
    deviations[i] = high - low;
  });
  SeamDeviation result;
  double squares = 0;
  for (const double deviation : deviations) {
    if (!(deviation >= 0)) continue;
    ++result.samples;
    squares += deviation * deviation;
    result.largest = std::max(result.largest, deviation);
  }
  if (result.samples > 0) result.rms = std::sqrt(squares / static_cast<double>(result.samples));
  return result;
}

}  // namespace scan
