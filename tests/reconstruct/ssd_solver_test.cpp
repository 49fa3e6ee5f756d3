// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "libscan/reconstruct/spline_field.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

// All columns of A, one after the other.
Eigen::MatrixXd dense_matrix(SsdSystem<double>& system, const OctreeGrid& grid) {
  LevelArrays unit = active_arrays(grid), column = unit;
  const std::size_t first = unit[0].size(), size = first + unit[1].size();
  Eigen::MatrixXd matrix(size, size);
  for (std::size_t i = 0; i < size; ++i) {
    double& one = i < first ? unit[0][i] : unit[1][i - first];
    one = 1;
    system.multiply(unit, column);
    one = 0;
    std::copy(column[0].begin(), column[0].end(), matrix.col(i).data());
    std::copy(column[1].begin(), column[1].end(), matrix.col(i).data() + first);
  }
  return matrix;
}

// Levels repeat each other's functions, so coefficients are not unique, but the function is.
TEST(SsdSolver, FindsTheFunctionOfADirectSolution) {
  const Samples samples = prepare_samples(torus_cloud(400));
  std::vector<int> depths;  // finer in one corner
  for (const auto& u : samples.points) depths.push_back(u[0] > 0.75 && u[1] > 0.5 ? 4 : 3);
  const OctreeGrid grid = make_octree_grid(samples.points, depths, 3);
  ASSERT_EQ(grid.levels.size(), 2u);
  SsdSystem<double> system(grid, samples, even_weights(samples, 5e6, 50));
  const SsdSolution iterated = solve(system, grid, 1e-9, 5000);
  ASSERT_EQ(iterated.stop, SolveStop::converged);
  EXPECT_LE(iterated.relative_residual, 1.01e-9);

  // A trace of the identity makes the semidefinite matrix definite; it adds 1e-13 |x|^2 or so.
  Eigen::MatrixXd matrix = dense_matrix(system, grid);
  matrix.diagonal().array() += 1e-13 * matrix.diagonal().maxCoeff();
  LevelArrays b = active_arrays(grid);
  system.right_side(b);
  Eigen::VectorXd right(matrix.rows());
  std::copy(b[0].begin(), b[0].end(), right.data());
  std::copy(b[1].begin(), b[1].end(), right.data() + b[0].size());
  const Eigen::VectorXd found = matrix.llt().solve(right);
  LevelArrays direct = active_arrays(grid);
  std::copy_n(found.data(), direct[0].size(), direct[0].begin());
  std::copy_n(found.data() + direct[0].size(), direct[1].size(), direct[1].begin());

  // The energy norm of the error is about 1e-9 of the solution's, and enters the energy squared.
  const double energy = system.energy(direct);
  EXPECT_NEAR(system.energy(iterated.coefficients), energy, 1e-9 * energy);
  for (const auto& u : samples.points)
    EXPECT_NEAR(evaluate(SplineField{grid, iterated.coefficients}, u).value,
                evaluate(SplineField{grid, direct}, u).value, 1e-6);
}

// Of all levels' entries: sqrt(sum of diagonal times squares).
double norm_by_diagonal(SsdSystem<double>& system, const OctreeGrid& grid, const LevelArrays& x) {
  double sum = 0;
  for (std::size_t l = 0; l < grid.levels.size(); ++l) {
    system.use_levels(l);  // whose diagonal is that of all samples
    const std::vector<double> diagonal = system.finest_diagonal();
    for (std::size_t i = 0; i < x[l].size(); ++i) sum += diagonal[i] * x[l][i] * x[l][i];
  }
  return std::sqrt(sum);
}

// An entry of A x is a sum over 125 taps and the functions of the samples around, each term rounded
// to e = 2^-24 of its size and none above the diagonal times the largest |x|, as A is positive.
// Some 200 roundings add up as chance does; so in the preconditioner's norm, about that of the
// inverse diagonal, the residual is off by 14 e sqrt(sum diagonal u^2), u the sums over levels that
// are rounded. The right side's own norm is near the solution's energy, b' x.
TEST(SsdSolver, LosesOnlyRoundingInFloats) {
  const Samples samples = prepare_samples(torus_cloud(3000));
  const OctreeGrid grid = make_octree_grid(samples.points, std::vector<int>(3000, 6), 4);
  const SampleWeights weights = even_weights(samples, 5e6, 50);
  SsdSystem<float> floats(grid, samples, weights);
  constexpr double asked = 1e-4;  // the least for which floats are taken (ssd_fit.cpp)
  const SsdSolution solution = solve(floats, grid, asked, 200);
  EXPECT_EQ(solution.stop, SolveStop::converged);
  const LevelArrays& found = solution.coefficients;
  SsdSystem<double> doubles(grid, samples, weights);
  LevelArrays sums = found;
  for (std::size_t l = 1; l < sums.size(); ++l) {
    const BlockLevel& level = grid.levels[l];
    std::vector<double> coarse(grid.levels[l - 1].blocks.size() * block_size),
        fine(level.blocks.size() * block_size);
    std::copy(sums[l - 1].begin(), sums[l - 1].end(), coarse.begin());
    prolong(grid, l, coarse, fine);
    for (std::size_t i = 0; i < sums[l].size(); ++i) sums[l][i] += fine[i];
  }
  const double size = norm_by_diagonal(doubles, grid, sums);
  doubles.use_levels(grid.levels.size() - 1);
  SsdSolver<double> solver(doubles, grid);
  solver.refresh();
  LevelArrays b = active_arrays(grid);
  doubles.right_side(b);
  double scale2 = 0;
  for (std::size_t l = 0; l < b.size(); ++l)
    for (std::size_t i = 0; i < b[l].size(); ++i) scale2 += b[l][i] * found[l][i];
  const double bound = 14 * std::ldexp(1.0, -24) * size / std::sqrt(scale2);
  const double left = solver.relative_residual(found);
  RecordProperty("change_over_bound", std::to_string((left - solution.relative_residual) / bound));
  EXPECT_NEAR(left, solution.relative_residual, bound);
  EXPECT_LT(bound, asked);
}

TEST(SsdSolver, SaysWhenItStopsEarly) {
  const Samples samples = prepare_samples(torus_cloud(2000));
  const OctreeGrid grid = make_octree_grid(samples.points, std::vector<int>(2000, 5), 4);
  SsdSystem<double> system(grid, samples, even_weights(samples, 5e6, 50));
  const SsdSolution solution = solve(system, grid, 1e-12, 5);
  EXPECT_EQ(solution.stop, SolveStop::iteration_limit);
  EXPECT_EQ(solution.iterations, 5);
  EXPECT_GT(solution.relative_residual, 1e-12);
}

}  // namespace
}  // namespace scan
