// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/bspline.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scan {
namespace {

constexpr double second_derivative[3] = {1, -2, 1};

// Values of function i at x on the row; derivative 0, 1 or 2.
double function(int i, double x, int derivative) {
  const int cell = static_cast<int>(std::floor(x)), local = i - cell;
  if (local < 0 || local > 2) return 0;
  const SplineWeights w = spline_weights(x - cell);
  return derivative == 0   ? w.value[local]
         : derivative == 1 ? w.slope[local]
                           : second_derivative[local];
}

// Gauss-Legendre with three nodes a cell is exact to degree 5; the products have degree 4 at most.
double quadrature(int i, int j, int derivative, int cells) {
  const double node = std::sqrt(0.6) / 2;
  double sum = 0;
  for (int cell = 0; cell < cells; ++cell)
    for (int k = -1; k <= 1; ++k) {
      const double x = cell + 0.5 + k * node;
      sum += (k == 0 ? 8 : 5) / 18.0 * function(i, x, derivative) * function(j, x, derivative);
    }
  return sum;
}

TEST(StencilRows, AreTheIntegralsByQuadrature) {
  for (const int cells : {1, 2, 3, 8}) {
    const auto rows = stencil_rows(cells, 1);
    ASSERT_EQ(rows.size(), cells + 2u);
    for (int i = 0; i < cells + 2; ++i)
      for (int tap = 0; tap < 5; ++tap) {
        const int j = i + tap - 2;
        const bool there = j >= 0 && j < cells + 2;
        // A dozen terms of at most 4: rounding below 12 * 4 * 2^-53.
        EXPECT_NEAR(rows[i].mass[tap], there ? quadrature(i, j, 0, cells) : 0, 1e-14);
        EXPECT_NEAR(rows[i].stiffness[tap], there ? quadrature(i, j, 1, cells) : 0, 1e-14);
        EXPECT_NEAR(rows[i].bending[tap], there ? quadrature(i, j, 2, cells) : 0, 1e-14);
      }
  }
}

TEST(StencilRows, ArePaddedWithZeros) {
  const auto rows = stencil_rows(8, 4);
  ASSERT_EQ(rows.size(), 12u);
  for (int tap = 0; tap < 5; ++tap) EXPECT_EQ(rows[10].mass[tap] + rows[11].bending[tap], 0);
}

TEST(SplineWeights, SumToOneAndReproduceLinearFunctions) {
  for (const double t : {0.0, 0.3, 0.5, 1.0}) {
    const SplineWeights w = spline_weights(t);
    EXPECT_NEAR(w.value[0] + w.value[1] + w.value[2], 1, 1e-15);
    // The functions are centred at -1/2, 1/2 and 3/2 of the cell.
    EXPECT_NEAR(-0.5 * w.value[0] + 0.5 * w.value[1] + 1.5 * w.value[2], t, 1e-15);
    EXPECT_NEAR(-0.5 * w.slope[0] + 0.5 * w.slope[1] + 1.5 * w.slope[2], 1, 1e-15);
  }
}

TEST(RefinementMask, WritesACoarseFunctionInFinerOnes) {
  for (const double x : {0.1, 0.9, 1.4, 2.2, 2.9}) {
    double fine = 0;
    for (int tap = 0; tap < 4; ++tap)
      fine += refinement_mask[tap] * function(4 - 2 + tap, 2 * x, 0);
    EXPECT_NEAR(fine, function(2, x, 0), 1e-15);
  }
}

}  // namespace
}  // namespace scan
