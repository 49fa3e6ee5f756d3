// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/bsdf/directional_table.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "libscan/core/parallel.h"

namespace scan::synth {
namespace {

TEST(DirectionalTable, FollowsASmoothFunction) {
  const auto f = [](double cosine) { return std::cos(3 * std::sqrt(cosine)); };
  const DirectionalTable table(f);
  for (int i = 0; i <= 640; ++i) {
    const double t = i / 640.0, cosine = t * t;
    // Catmull and Rom's spline: the third derivative (27) times h^3 / (12 sqrt(3) ...) stays below
    // 27 h^3 / 24 with h = 1 / 64; the first and last interval have one-sided slopes, 9 h^2 / 8
    const bool at_end = t < 1.0 / 64 || t > 63.0 / 64;
    const double h = 1.0 / 64;
    EXPECT_NEAR(table(cosine), f(cosine), at_end ? 9 * h * h / 8 : 27 * h * h * h / 24) << t;
  }
  EXPECT_EQ(table(-1), table(0));
  EXPECT_EQ(table(2), table(1));
}

TEST(DirectionalTable, QuadratureIsExactForPolynomials) {
  for (const int power : {0, 1, 7, 64, 127})
    EXPECT_NEAR(integral_over_unit([&](double x) { return std::pow(x, power); }), 1.0 / (power + 1),
                1e-15 * 10);
}

struct Here {};
struct There {};

TEST(Tabulated, MakesEachValueOnceAndKeepsItsPlace) {
  std::atomic<int> made = 0;
  const auto ask = [&](double key) -> const double& {
    return tabulated<Here, double>({key}, [&] {
      ++made;
      return key * key;
    });
  };
  const double* first = &ask(3);
  // more keys than a thread remembers, from many threads
  parallel_for(
      400, [&](std::size_t i) { EXPECT_EQ(ask(static_cast<double>(i % 20)), (i % 20) * (i % 20)); },
      1);
  EXPECT_EQ(made, 20);
  EXPECT_EQ(&ask(3), first);
  EXPECT_EQ((tabulated<There, double>({3}, [] { return 7.0; })), 7);
}

}  // namespace
}  // namespace scan::synth
