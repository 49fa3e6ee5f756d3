// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scan::synth {
namespace {

TEST(GaussLegendre, IsExactForPolynomials) {
  for (const int count : {1, 2, 5, 8, 20, 40}) {
    const auto nodes = gauss_legendre(count);
    ASSERT_EQ(nodes.size(), static_cast<std::size_t>(count));
    for (const int degree : {0, 1, 2 * count - 1}) {
      double sum = 0;
      for (const QuadratureNode& node : nodes) sum += node.weight * std::pow(node.x, degree);
      EXPECT_NEAR(sum, 1.0 / (degree + 1), 1e-14) << count << " " << degree;
    }
    double beyond = 0;
    for (const QuadratureNode& node : nodes) beyond += node.weight * std::pow(node.x, 2 * count);
    if (count <= 8) {
      EXPECT_GT(std::abs(beyond - 1.0 / (2 * count + 1)), 1e-13) << "and for no more";
    }
  }
}

// 241 nodes with step 1/32 reach to 1e-29 of each end; what is left is the rounding of their sum.
TEST(DoubleExponentialRule, EndsAtSingularities) {
  EXPECT_NEAR(integrate_with_singular_ends(2, [](double x) { return std::log(x); }),
              2 * std::log(2.0) - 2, 1e-13);
  EXPECT_NEAR(
      integrate_with_singular_ends(std::numbers::pi / 2, [](double x) { return std::cos(x); }), 1,
      1e-13);
}

}  // namespace
}  // namespace scan::synth
