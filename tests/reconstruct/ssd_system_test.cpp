// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_system.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "libscan/reconstruct/block_factors.h"
#include "libscan/reconstruct/spline_field.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

// A torus with levels 3 to 6, the deepest on one side only.
struct Problem {
  Samples samples = prepare_samples(torus_cloud(600));
  OctreeGrid grid;

  Problem() {
    std::vector<int> depths;
    for (const auto& u : samples.points) depths.push_back(u[0] > 0.5 ? 6 : 5);
    grid = make_octree_grid(samples.points, depths, 4);
  }
};

LevelArrays random_arrays(const OctreeGrid& grid, std::uint64_t seed) {
  LevelArrays arrays = active_arrays(grid);
  RandomStream random(seed, 0, 0);
  for (std::size_t l = 0; l < arrays.size(); ++l)
    for (std::size_t i = 0; i < arrays[l].size(); ++i) {
      const BlockPlace& p = grid.levels[l].blocks[i / block_size];
      const int slot = static_cast<int>(i % block_size), last = grid.levels[l].cells() + 1;
      const bool in_cube = 4 * p[0] + slot % 4 <= last && 4 * p[1] + slot / 4 % 4 <= last &&
                           4 * p[2] + slot / 16 <= last;
      if (in_cube) arrays[l][i] = random.uniform() - 0.5;
    }
  return arrays;
}

double dot(const LevelArrays& a, const LevelArrays& b) {
  double sum = 0;
  for (std::size_t l = 0; l < a.size(); ++l)
    sum += std::inner_product(a[l].begin(), a[l].end(), b[l].begin(), 0.0);
  return sum;
}

TEST(SsdSystem, EnergyIsThatOfTheFieldAtTheSamples) {
  Problem problem;
  SsdSystem<double> system(problem.grid, problem.samples, even_weights(problem.samples, 0, 0));
  const LevelArrays x = random_arrays(problem.grid, 1);
  const double bending = system.energy(x);
  system.set_weights(even_weights(problem.samples, 5e13, 5e9));
  const SplineField field{problem.grid, x};
  double expected = 0;
  const double total =
      std::accumulate(problem.samples.area.begin(), problem.samples.area.end(), 0.0);
  for (std::size_t i = 0; i < problem.samples.points.size(); ++i) {
    const FieldValue f = evaluate(field, problem.samples.points[i]);
    expected +=
        problem.samples.area[i] / total *
        (5e13 * f.value * f.value + 5e9 * (f.gradient - problem.samples.normals[i]).squaredNorm());
  }
  // A few thousand terms of one sign: relative rounding far below 1e-11.
  EXPECT_NEAR(system.energy(x) - bending, expected, 1e-11 * (expected + bending));
  EXPECT_GT(expected, bending);
}

// |D^2 f|^2 by quadrature: in each finest cell of any place the function is one polynomial of
// degree two along each axis, its products have degree four, and three Gauss nodes an axis are
// exact.
TEST(SsdSystem, SmoothnessIsTheIntegralOverTheCube) {
  Problem problem;
  SsdSystem<double> system(problem.grid, problem.samples, even_weights(problem.samples, 0, 0));
  const LevelArrays x = random_arrays(problem.grid, 2);
  const SplineField field{problem.grid, x};
  const auto second = [&](const FieldCell& cell, const Eigen::Vector3d& t) {
    // The gradient is at most quadratic along an axis: central differences are exact.
    double sum = 0;
    const double h = 1.0 / 16, step = 1 << cell.depth;
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d d = h * Eigen::Vector3d::Unit(a);
      sum += ((evaluate(cell, t + d).gradient - evaluate(cell, t - d).gradient) * step / (2 * h))
                 .squaredNorm();
    }
    return sum;
  };
  const std::function<double(const FieldCell&)> integral = [&](const FieldCell& cell) -> double {
    double sum = 0;
    if (has_finer_functions(field, cell)) {
      for (int octant = 0; octant < 8; ++octant) sum += integral(child_cell(field, cell, octant));
      return sum;
    }
    for (int i = 0; i < 27; ++i) {
      const Eigen::Vector3i k(i % 3, i / 3 % 3, i / 9);
      double weight = 1;
      for (int a = 0; a < 3; ++a) weight *= k[a] == 1 ? 8. / 18 : 5. / 18;
      sum +=
          weight * second(cell, Eigen::Vector3d::Constant(0.5) +
                                    std::sqrt(0.6) / 2 * (k.cast<double>().array() - 1).matrix());
    }
    return sum / std::pow(8, cell.depth);
  };
  double expected = 0;
  for (int i = 0; i < 512; ++i)
    expected += integral(coarsest_cell(field, {i % 8, i / 8 % 8, i / 64}));
  // Differences over h = 1/16 lose four bits of 53; sums of one sign: 1e-10 is generous.
  EXPECT_NEAR(system.energy(x), expected, 1e-10 * expected);
}

TEST(SsdSystem, HalfTheGradientIsTheResidual) {
  Problem problem;
  SsdSystem<double> system(problem.grid, problem.samples, even_weights(problem.samples, 5e6, 50));
  const LevelArrays x = random_arrays(problem.grid, 3), direction = random_arrays(problem.grid, 4);
  LevelArrays product = active_arrays(problem.grid), right = product;
  system.multiply(x, product);
  system.right_side(right);
  const double slope = 2 * (dot(product, direction) - dot(right, direction));
  const auto energy_at = [&](double t) {
    LevelArrays moved = x;
    for (std::size_t l = 0; l < moved.size(); ++l)
      for (std::size_t i = 0; i < moved[l].size(); ++i) moved[l][i] += t * direction[l][i];
    return system.energy(moved);
  };
  // The energy is quadratic: central differences have rounding error only, energy * 2^-53 / step.
  const double difference = (energy_at(0.5) - energy_at(-0.5)) / 1.0;
  EXPECT_NEAR(slope, difference, 1e-11 * energy_at(0.5));
}

TEST(SsdSystem, IsSymmetric) {
  Problem problem;
  SsdSystem<double> system(problem.grid, problem.samples, even_weights(problem.samples, 5e6, 50));
  const LevelArrays x = random_arrays(problem.grid, 5), y = random_arrays(problem.grid, 6);
  LevelArrays ax = active_arrays(problem.grid), ay = ax;
  system.multiply(x, ax);
  system.multiply(y, ay);
  const double size = std::sqrt(dot(ax, ax) * dot(y, y));
  EXPECT_NEAR(dot(ax, y), dot(ay, x), 1e-13 * size);
}

// Of one function.
LevelArrays column_of(SsdSystem<double>& system, const OctreeGrid& grid, std::size_t l,
                      std::size_t i) {
  LevelArrays unit = active_arrays(grid), column = unit;
  unit[l][i] = 1;
  system.multiply(unit, column);
  return column;
}

TEST(SsdSystem, KnowsItsFinestDiagonal) {
  Problem problem;
  SsdSystem<double> system(problem.grid, problem.samples, even_weights(problem.samples, 5e6, 50));
  for (std::size_t l = problem.grid.levels.size(); l-- > 0;) {
    system.use_levels(l);
    const std::vector<double> diagonal = system.finest_diagonal();
    for (std::size_t i = l; i < diagonal.size(); i += diagonal.size() / 7) {
      const double found = column_of(system, problem.grid, l, i)[l][i];
      if (found == 0)
        EXPECT_EQ(diagonal[i], 1);  // outside the cube
      else
        EXPECT_NEAR(found, diagonal[i], 1e-13 * found);
    }
  }
}

// The samples' matrices go from level to level: the coarsest has met them all.
TEST(SsdSystem, KnowsItsCoarsestMatrix) {
  Problem problem;
  SsdSystem<double> system(problem.grid, problem.samples, even_weights(problem.samples, 5e6, 50));
  const std::vector<std::uint32_t> functions = system.coarsest_functions();
  EXPECT_EQ(functions.size(), 1000u);  // 8 cells and two more functions an axis
  CellMatrices term;
  for (std::size_t l = system.levels_of_blocks(); l-- > 0;) term = system.sample_matrices(l, term);
  const Eigen::MatrixXd coarsest = system.coarsest_matrix(term);
  for (std::size_t row = 3; row < functions.size(); row += 140) {
    const LevelArrays column = column_of(system, problem.grid, 0, functions[row]);
    for (std::size_t j = 0; j < functions.size(); ++j)
      EXPECT_NEAR(column[0][functions[j]], coarsest(j, row), 1e-13 * coarsest(row, row));
  }
}

TEST(SsdSystem, SolvesItsBlocks) {
  Problem problem;
  SsdSystem<double> system(problem.grid, problem.samples, even_weights(problem.samples, 5e6, 50));
  CellMatrices term;
  for (std::size_t l = system.levels_of_blocks(); l-- > 1;) {
    const BlockLevel& level = problem.grid.levels[l];
    term = system.sample_matrices(l, term);
    const BlockFactors factors(level, system.bending(l), term);
    for (std::size_t b = l; b < level.active; b += level.active / 5) {
      // Functions in the middle of the block and at its corners.
      for (const std::size_t slot : {21u, 0u, 63u}) {
        const LevelArrays column = column_of(system, problem.grid, l, b * block_size + slot);
        if (column[l][b * block_size + slot] == 0) continue;  // outside the cube
        std::array<double, block_size> found;
        factors.solve(b, column[l].data() + b * block_size, found.data());
        // Float's 6e-8, times the condition of a block, some 1e3.
        for (std::size_t i = 0; i < block_size; ++i) EXPECT_NEAR(found[i], i == slot, 1e-4);
      }
    }
  }
}

// The column of a function, cut to its octet, is what its octet's equations answer with the
// function itself.
TEST(SsdSystem, SolvesItsOctets) {
  Problem problem;
  SsdSystem<double> system(problem.grid, problem.samples, even_weights(problem.samples, 5e6, 50));
  const std::size_t l = problem.grid.levels.size() - 2;
  const BlockLevel& level = problem.grid.levels[l];
  const OctetFactors factors = system.octet_factors();
  for (std::size_t b = 0; b < level.active; b += level.active / 9) {
    for (const int slot : {21, 0, 63, 26}) {
      const std::size_t own = b * block_size + static_cast<std::size_t>(slot);
      const LevelArrays column = column_of(system, problem.grid, l, own);
      if (column[l][own] == 0) continue;  // outside the cube
      std::array<double, block_size> right{}, found;
      for (int i = 0; i < block_size; ++i)
        if (i % 4 / 2 == slot % 4 / 2 && i / 8 % 2 == slot / 8 % 2 && i / 32 == slot / 32)
          right[static_cast<std::size_t>(i)] =
              column[l][b * block_size + static_cast<std::size_t>(i)];
      factors.solve(b, right.data(), found.data());
      // Float's 6e-8, times the condition of an octet, some 1e2.
      for (int i = 0; i < block_size; ++i)
        EXPECT_NEAR(found[static_cast<std::size_t>(i)], i == slot, 1e-5);
    }
  }
}

}  // namespace
}  // namespace scan
