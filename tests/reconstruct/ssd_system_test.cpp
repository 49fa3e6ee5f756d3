// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_system.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

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
  SsdSystem system(problem.grid, problem.samples, even_weights(problem.samples, 0, 0));
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
  SsdSystem system(problem.grid, problem.samples, even_weights(problem.samples, 0, 0));
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
  SsdSystem system(problem.grid, problem.samples, even_weights(problem.samples, 5e6, 50));
  const LevelArrays x = random_arrays(problem.grid, 3), direction = random_arrays(problem.grid, 4);
  LevelArrays product = active_arrays(problem.grid);
  system.multiply(x, product);
  const double slope = 2 * (dot(product, direction) - dot(system.right_side(), direction));
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
  SsdSystem system(problem.grid, problem.samples, even_weights(problem.samples, 5e6, 50));
  const LevelArrays x = random_arrays(problem.grid, 5), y = random_arrays(problem.grid, 6);
  LevelArrays ax = active_arrays(problem.grid), ay = ax;
  system.multiply(x, ax);
  system.multiply(y, ay);
  const double size = std::sqrt(dot(ax, ax) * dot(y, y));
  EXPECT_NEAR(dot(ax, y), dot(ay, x), 1e-13 * size);
}

TEST(SsdSystem, KnowsItsDiagonalAndItsCoarsestMatrix) {
  Problem problem;
  SsdSystem system(problem.grid, problem.samples, even_weights(problem.samples, 5e6, 50));
  const LevelArrays diagonal = system.diagonal();
  const Eigen::MatrixXd coarsest = system.coarsest_matrix();
  const std::vector<std::uint32_t> functions = system.coarsest_functions();
  EXPECT_EQ(functions.size(), 1000u);  // 8 cells and two more functions an axis
  for (std::size_t l = 0; l < diagonal.size(); ++l)
    for (std::size_t i = l; i < diagonal[l].size(); i += diagonal[l].size() / 7) {
      LevelArrays unit = active_arrays(problem.grid), column = unit;
      unit[l][i] = 1;
      system.multiply(unit, column);
      if (column[l][i] == 0) continue;  // outside the cube
      EXPECT_NEAR(column[l][i], diagonal[l][i], 1e-13 * diagonal[l][i]);
      if (l == 0) {
        const auto row =
            std::lower_bound(functions.begin(), functions.end(), i) - functions.begin();
        ASSERT_EQ(functions[row], i);
        for (std::size_t j = 0; j < functions.size(); ++j)
          EXPECT_NEAR(column[0][functions[j]], coarsest(j, row), 1e-13 * diagonal[0][i]);
      }
    }
}

}  // namespace
}  // namespace scan
