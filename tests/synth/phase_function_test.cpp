// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/phase_function.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "libscan/core/error.h"
#include "libscan/core/random.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

const std::vector<PhaseFunction>& kinds() {
  static const std::vector<PhaseFunction> all = {HenyeyGreenstein{-0.5},  HenyeyGreenstein{0},
                                                 HenyeyGreenstein{0.5},   HenyeyGreenstein{0.9},
                                                 HenyeyGreenstein{1e-12}, Rayleigh{}};
  return all;
}

struct Integral {
  double value = 0;
  double error = 0;
};

template <class F>
double simpson(F&& f, double low, double high, int steps) {
  const double h = (high - low) / steps;
  double sum = f(low) + f(high);
  for (int i = 1; i < steps; ++i) sum += f(low + i * h) * (i % 2 ? 4 : 2);
  return sum * h / 3;
}

// Simpson's rule at two step sizes; the finer one is wrong by 1/15 of the difference, doubled here,
// and by the rounding of 40000 additions.
template <class F>
Integral integrate(F&& f, double low, double high, int steps) {
  const double fine = simpson(f, low, high, 2 * steps);
  return {fine, std::abs(fine - simpson(f, low, high, steps)) * 2 / 15 + 4e-12};
}

TEST(PhaseFunction, IntegratesToOneWithItsMeanCosine) {
  for (const PhaseFunction& phase : kinds()) {
    const Integral total =
        integrate([&](double c) { return 2 * pi * phase_value(phase, c); }, -1, 1, 20000);
    EXPECT_NEAR(total.value, 1, total.error);
    const Integral mean =
        integrate([&](double c) { return 2 * pi * c * phase_value(phase, c); }, -1, 1, 20000);
    EXPECT_NEAR(mean.value, mean_cosine(phase), mean.error);
    EXPECT_LT(total.error + mean.error, 1e-7) << "the quadrature is good enough to tell";
  }
}

// Rayleigh's 1 + c^2; a lobe's value at its ends is (1 + a) / (4 pi (1 - a)^2) and (1 - a) / (4 pi
// (1 + a)^2).
TEST(PhaseFunction, HasTheValuesOfTheTextbook) {
  EXPECT_DOUBLE_EQ(phase_value(HenyeyGreenstein{0}, 0.3), 1 / (4 * pi));
  EXPECT_DOUBLE_EQ(phase_value(Rayleigh{}, 1) / phase_value(Rayleigh{}, 0), 2);
  for (const double a : {0.5, 0.9, 1 - 0x1p-20, 1 - 0x1p-50}) {
    const double ahead = (1 + a) / (4 * pi * (1 - a) * (1 - a));
    const double behind = (1 - a) / (4 * pi * (1 + a) * (1 + a));
    EXPECT_NEAR(phase_value(HenyeyGreenstein{a}, 1) / ahead, 1, 1e-14);
    EXPECT_NEAR(phase_value(HenyeyGreenstein{-a}, -1) / ahead, 1, 1e-14);
    EXPECT_NEAR(phase_value(HenyeyGreenstein{a}, -1) / behind, 1, 1e-14);
  }
}

// Ten bins of cosine, edges where the lobe's distribution needs them, times eight of azimuth.
TEST(PhaseFunction, SamplesByItsDensity) {
  const Eigen::Vector3d travel = Eigen::Vector3d(0.3, -0.5, 0.7).normalized();
  const Eigen::Vector3d across = travel.cross(Eigen::Vector3d(1, 2, 3)).normalized();
  const std::array<double, 11> edges = {-1, -0.9, -0.7, -0.4, 0, 0.3, 0.6, 0.8, 0.9, 0.97, 1};
  const int count = 200000, turns = 8;
  for (const PhaseFunction& phase : kinds()) {
    std::vector<double> found(10 * turns, 0);
    RandomStream random(1, 2, 3);
    for (int i = 0; i < count; ++i) {
      const double u = random.uniform(), v = random.uniform();
      const Eigen::Vector3d out = sample_phase(phase, travel, {u, v});
      ASSERT_NEAR(out.norm(), 1, 1e-14);
      const double cosine = std::clamp(out.dot(travel), -1.0, 1.0);
      int bin = 0;
      while (bin < 9 && cosine >= edges[bin + 1]) ++bin;
      const double azimuth = std::atan2(out.dot(travel.cross(across)), out.dot(across));
      ++found[bin * turns + std::min(turns - 1, static_cast<int>((azimuth / pi + 1) * turns / 2))];
    }
    double chi2 = 0;
    for (int i = 0; i < 10 * turns; ++i) {
      const double share = simpson([&](double c) { return 2 * pi * phase_value(phase, c); },
                                   edges[i / turns], edges[i / turns + 1], 1000);
      const double expected = count * share / turns;
      ASSERT_GT(expected, 5);
      chi2 += std::pow(found[i] - expected, 2) / expected;
    }
    EXPECT_LT(chi2, 128.6);  // 0.03 % quantile of chi-square, 79 degrees of freedom
  }
}

// Inverse transform: the distribution function at the sampled cosine is u again. Of narrow lobes
// the angle is compared, since the cosine has no digits left for it; the reference in long double.
TEST(PhaseFunction, KeepsNarrowLobesNarrow) {
  const Eigen::Vector3d travel = Eigen::Vector3d::UnitX();
  for (const double a : {1e-9, 0.3, 0.999, 1 - 0x1p-20}) {
    for (const double u : {0.01, 0.25, 0.5, 0.9}) {
      const long double g = a, s = (1 - g * g) / (1 - g + 2 * g * u);
      const long double from_one = (s * s - (1 - g) * (1 - g)) / (2 * g);  // 1 - c
      const double angle = static_cast<double>(2 * std::asin(std::sqrt(from_one / 2)));
      const Eigen::Vector3d out = sample_phase(HenyeyGreenstein{a}, travel, {u, 0.1});
      // the reference's own rounding, 1e-19 / (2 g (1 - c)), is the larger one
      const double error = 1e-18 / static_cast<double>(g * from_one) + 1e-14;
      EXPECT_NEAR(std::atan2(out.tail<2>().norm(), out.x()) / angle, 1, error) << a << " " << u;
      const Eigen::Vector3d back = sample_phase(HenyeyGreenstein{-a}, travel, {u, 0.1});
      EXPECT_NEAR(std::atan2(back.tail<2>().norm(), -back.x()) / angle, 1, error) << a << " " << u;
    }
  }
}

TEST(PhaseFunction, SamplesTheEndsOfTheUnitSquare) {
  for (const PhaseFunction& phase : kinds())
    for (const double u : {0.0, 0x1p-53, 1 - 0x1p-53})
      EXPECT_NEAR(sample_phase(phase, Eigen::Vector3d::UnitZ(), {u, u}).norm(), 1, 1e-15);
  const PhaseFunction needle = HenyeyGreenstein{1 - 0x1p-53};
  for (const double u : {0.0, 0x1p-53, 0.5, 1 - 0x1p-53})
    EXPECT_NEAR(sample_phase(needle, Eigen::Vector3d::UnitZ(), {u, 0.5}).norm(), 1, 1e-15);
}

TEST(PhaseFunction, NamesWhatIsWrong) {
  for (const double g : {1.0, -1.0, 2.0, std::numeric_limits<double>::quiet_NaN()}) {
    try {
      check(HenyeyGreenstein{g}, "scene/medium/phase");
      ADD_FAILURE() << g << " passed";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("scene/medium/phase/mean_cosine: "),
                std::string::npos);
      EXPECT_NE(std::string(error.what()).find("must be between -1 and 1"), std::string::npos);
    }
  }
  check(HenyeyGreenstein{-0.999}, "phase");
  check(Rayleigh{}, "phase");
}

}  // namespace
}  // namespace scan::synth
