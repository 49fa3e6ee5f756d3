// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_parts.h"

#include <gtest/gtest.h>

#include <cstring>

#include "libscan/core/cost.h"
#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/isosurface.h"
#include "libscan/reconstruct/ssd.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

constexpr int complete_depth = 4;

double torus_distance(const Eigen::Vector3d& x) {
  return std::hypot(std::hypot(x[0], x[1]) - 1, x[2]) - 0.35;
}

double spacing_of(const Samples& samples) {
  double area = 0;
  for (const double a : samples.area) area += a / static_cast<double>(samples.area.size());
  return std::sqrt(area);
}

struct Distances {
  double rms = 0, largest = 0;
};

// Of the mesh's vertices from the zero set of a field, to first order; beside the walls between
// eight parts, or elsewhere.
Distances distances(const Mesh& mesh, const SplineField& field, bool at_seams) {
  Distances result;
  double count = 0;
  for (const Eigen::Vector3d& u : mesh.vertices) {
    if ((shares_at(u, 1).count > 1) != at_seams) continue;
    const FieldValue f = evaluate(field, u);
    const double distance = std::abs(f.value) / f.gradient.norm();
    result.rms += distance * distance;
    result.largest = std::max(result.largest, distance);
    ++count;
  }
  result.rms = std::sqrt(result.rms / count);
  return result;
}

// Both are solved to a part e of the solution's energy norm, whose square is that of the normals,
// sum g. So sum v d^2 < e^2 sum g for the distances d that are left of either, and g / v is some
// area / 12 for exact samples: d < e sqrt(area / 12) in the mean square. What a part does not see,
// two cells of the coarse cloud and more away, adds the same again at most.
TEST(SsdParts, AgreeWithTheWhole) {
  const Samples samples = prepare_samples(torus_cloud(10000));
  const std::vector<int> depths = sample_depths(samples, complete_depth, 12);
  const SsdProblem problem{samples, depths, complete_depth, 12};
  const SsdFitOptions options{.relative_residual = 1e-3};
  const OctreeGrid grid = make_octree_grid(samples.points, depths, complete_depth);
  const SsdFit whole = fit_surface(grid, samples, options);
  const SsdParts parts = fit_parts(problem, options, 1);
  EXPECT_EQ(parts.stop, SolveStop::converged);
  EXPECT_EQ(parts.finest_depth, grid.finest_depth());
  for (const double length : parts.length) EXPECT_GT(length, 0);
  const Mesh mesh = zero_level_set(parts.field(), grid.finest_depth() + 1);
  const SplineField field{grid, whole.solution.coefficients};
  const double bound = 3e-3 * spacing_of(samples) / std::sqrt(12);
  const Distances inside = distances(mesh, field, false), seams = distances(mesh, field, true);
  RecordProperty("inside_over_bound", std::to_string(inside.rms / bound));
  RecordProperty("seams_over_bound", std::to_string(seams.rms / bound));
  EXPECT_LT(inside.rms, bound);
  EXPECT_LT(seams.rms, bound);
  const SeamDeviation seam = seam_deviation(parts, samples);
  EXPECT_GT(seam.samples, samples.points.size() / 20);
  EXPECT_LT(seam.rms, 2 * bound);  // neighbours differ by what either has
  EXPECT_GE(seam.largest, seam.rms);
}

// Coefficients of a linear function are its values in the middle of the splines.
LevelArrays linear_field(const OctreeGrid& grid, const Eigen::Vector3d& slope, double constant) {
  LevelArrays coefficients = active_arrays(grid);
  const BlockLevel& level = grid.levels.front();
  for (std::size_t i = 0; i < coefficients[0].size(); ++i) {
    const BlockPlace& p = level.blocks[i / block_size];
    const int slot = static_cast<int>(i % block_size);
    const Eigen::Vector3d middle(4 * p[0] + slot % 4 - 0.5, 4 * p[1] + slot / 4 % 4 - 0.5,
                                 4 * p[2] + slot / 16 - 0.5);
    coefficients[0][i] = slope.dot(middle) / level.cells() + constant;
  }
  return coefficients;
}

TEST(SeamDeviation, IsTheDistanceOfTwoPlanes) {
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, 4).normalized();
  const double apart = 0.013;
  SsdParts parts{.split = 1};
  const std::vector<Eigen::Vector3d> one_point{{0.5, 0.5, 0.5}};
  for (int f = 0; f < 2; ++f) {
    parts.grids.push_back(make_octree_grid(one_point, std::vector<int>{3}, 3));
    parts.coefficients.push_back(linear_field(parts.grids.back(), 3 * normal, 3 * apart * f));
  }
  parts.field_of_part = {0, 1, 0, 1, 0, 1, 0, 1};
  Samples samples;
  RandomStream random(1, 0, 0);
  std::size_t beside_the_wall = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    samples.points.emplace_back(x, y, z);
    beside_the_wall += std::abs(x - 0.5) < 1.0 / 32 || std::abs(y - 0.5) < 1.0 / 32 ||
                       std::abs(z - 0.5) < 1.0 / 32;
  }
  const SeamDeviation seam = seam_deviation(parts, samples);
  EXPECT_EQ(seam.samples, beside_the_wall);
  EXPECT_NEAR(seam.largest, apart, 1e-12);
  EXPECT_LT(seam.rms, apart);
}

double mean_distance(const SurfaceResult& result) {
  double sum = 0;
  for (const auto& v : result.surface.vertices) sum += std::abs(torus_distance(v));
  return sum / static_cast<double>(result.surface.vertices.size());
}

// By the bounds of SsdParts.AgreeWithTheWhole, whose share e is the one chosen for exact samples:
// parts are off the whole by 3 e sqrt(area / 12) at most in the root of the mean square, hence in
// the mean, and neighbours off each other by twice that.
TEST(Ssd, IsAsGoodInPartsAsAtOnce) {
  const PointCloud cloud = torus_cloud(12000);
  const SurfaceResult whole = ssd(cloud);
  EXPECT_EQ(whole.parts.parts_per_axis, 1u);
  const auto in_parts = [&](int threads) {
    const ThreadLimit limit(threads);
    return ssd(cloud, {.memory_gib = 0.031});
  };
  const SurfaceResult parts = in_parts(1);
  EXPECT_EQ(parts.parts.parts_per_axis, 2u);
  EXPECT_GT(parts.parts.seam_points, cloud.size() / 20);
  const EdgeCensus census = edge_census(parts.surface);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.components, 1u);
  EXPECT_EQ(census.genus, 1);
  const double area_m2 = 4 * std::numbers::pi * std::numbers::pi * 0.35 / cloud.size();
  const double bound_m = 3e-3 * std::sqrt(area_m2 / 12);
  RecordProperty("seams_over_bound", std::to_string(parts.parts.seam_rms_m / (2 * bound_m)));
  RecordProperty("change_over_bound",
                 std::to_string((mean_distance(parts) - mean_distance(whole)) / bound_m));
  RecordProperty("whole_over_bound", std::to_string(mean_distance(whole) / bound_m));
  EXPECT_LT(parts.parts.seam_rms_m, 2 * bound_m);
  EXPECT_LT(mean_distance(parts), mean_distance(whole) + bound_m);
  const SurfaceResult with_two_threads = in_parts(2);
  const auto& a = parts.surface.vertices;
  const auto& b = with_two_threads.surface.vertices;
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])), 0);
}

TEST(Ssd, RefusesWhatDoesNotFitEvenInParts) {
  try {
    ssd(torus_cloud(20000), {.memory_gib = 0.005});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::resource);
  }
}

void expect_forecast(const PointCloud& cloud, int split) {
  const Samples samples = prepare_samples(cloud);
  const std::vector<int> depths = sample_depths(samples, complete_depth, 12);
  const int finest = *std::max_element(depths.begin(), depths.end());
  const SsdProblem problem{samples, depths, complete_depth, finest + 1};
  const double forecast =
      split == 0 ? forecast_gib(problem, 1e9) : forecast_in_parts_gib(problem, split, 1e9);
  restart_peak_memory();
  const double before_mib = peak_memory_mib();
  const SurfaceResult result = ssd(cloud, {.memory_gib = split == 0 ? 16 : forecast});
  const double took_mib = peak_memory_mib() - before_mib;
  EXPECT_EQ(result.parts.parts_per_axis, std::size_t{1} << split);
  testing::Test::RecordProperty("forecast_share", std::to_string(1024 * forecast / took_mib));
  EXPECT_LT(took_mib, 1.5 * 1024 * forecast);
  EXPECT_GT(took_mib, 1024 * forecast / 1.5);
}

TEST(SsdParts, ForecastTheMemoryOfExactSamples) {
  expect_forecast(torus_cloud(30000), 0);
}

TEST(SsdParts, ForecastTheMemoryOfScatteredSamples) {
  expect_forecast(scattered(torus_cloud(60000), 0.004), 0);
}

TEST(SsdParts, ForecastTheirMemory) {
  expect_forecast(torus_cloud(25000, 1, 0.15), 1);
}

}  // namespace
}  // namespace scan
