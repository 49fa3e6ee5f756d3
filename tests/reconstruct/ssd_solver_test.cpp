// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "libscan/reconstruct/spline_field.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

// All columns of A, one after the other.
Eigen::MatrixXd dense_matrix(SsdSystem& system, const OctreeGrid& grid) {
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
  SsdSystem system(grid, samples, even_weights(samples, 5e6, 50));
  const SsdSolution iterated = solve(system, grid, 1e-9, 5000);
  ASSERT_EQ(iterated.stop, SolveStop::converged);
  EXPECT_LE(iterated.relative_residual, 1.01e-9);

  // A trace of the identity makes the semidefinite matrix definite; it adds 1e-13 |x|^2 or so.
  Eigen::MatrixXd matrix = dense_matrix(system, grid);
  matrix.diagonal().array() += 1e-13 * matrix.diagonal().maxCoeff();
  const LevelArrays b = system.right_side();
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

TEST(SsdSolver, SaysWhenItStopsEarly) {
  const Samples samples = prepare_samples(torus_cloud(2000));
  const OctreeGrid grid = make_octree_grid(samples.points, std::vector<int>(2000, 5), 4);
  SsdSystem system(grid, samples, even_weights(samples, 5e6, 50));
  const SsdSolution solution = solve(system, grid, 1e-12, 5);
  EXPECT_EQ(solution.stop, SolveStop::iteration_limit);
  EXPECT_EQ(solution.iterations, 5);
  EXPECT_GT(solution.relative_residual, 1e-12);
}

}  // namespace
}  // namespace scan
