// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/local_smoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libscan/core/random.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

// The integral over waves up to `last` by the midpoint rule in t = x / (1 + x).
double integral(double last) {
  const int steps = 200000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) / steps, x = t / (1 - t);
    if (x < last) sum += x / (1 + x * x * x) / ((1 - t) * (1 - t)) / steps;
  }
  return sum / (2 * std::numbers::pi);
}

TEST(LocalSmoothing, LeverageAndVarianceAreIntegralsOverWaves) {
  // share / (1 + share) differs from the share by its square.
  const double area = 1e-6, length = 1;
  EXPECT_NEAR(leverage(area, length) / area, integral(1e9), 1e-5);
  EXPECT_NEAR(posterior_variance(area, length) / area,
              integral(std::numbers::pi * lengths_per_cell), 1e-5);
}

TEST(LocalSmoothing, SharesAreBelowOne) {
  EXPECT_LT(leverage(1, 1e-6), 1);
  EXPECT_LT(posterior_variance(1, 1e-6), 1);
}

Samples unit_square(std::size_t side, double sigma) {
  Samples samples;
  for (std::size_t i = 0; i < side * side; ++i) {
    samples.points.emplace_back((i % side + 0.5) / side, (i / side + 0.5) / side, 0.5);
    samples.normals.push_back(Eigen::Vector3d::UnitZ());
    samples.area.push_back(1.0 / (side * side));
    samples.sigma.push_back(sigma);
  }
  return samples;
}

std::vector<double> all_trusted(const Samples& samples) {
  return std::vector<double>(samples.points.size(), 1.0);
}

// Residuals that no length lowers ask for the longest one, those that fall by more than the noise a
// fit takes up for the shortest; each side of the square gets its own.
TEST(LocalSmoothing, ChoosesByRegion) {
  const Samples samples = unit_square(100, 1e-3);
  LocalSmoothing smoothing(samples);
  for (const double trial : {0.04, 0.02, 0.01}) {
    std::vector<double> residuals;
    for (const auto& u : samples.points) residuals.push_back(u[0] < 0.5 ? 1e-3 : trial);
    smoothing.judge(trial, residuals, all_trusted(samples));
  }
  const std::vector<double> length = smoothing.lengths();
  for (std::size_t i = 0; i < length.size(); ++i) {
    // Regions are sqrt(50 / 10000) wide and one lies across the middle. The sums of the trial 0.02,
    // the first that is compared, reach ceil(2 (2 * 0.02 / 0.071)^2) = 1 region, mixed lengths one
    // more.
    const double margin = (1 + 1 + 1) * std::sqrt(50e-4);
    if (samples.points[i][0] < 0.5 - margin) {
      EXPECT_NEAR(length[i], 0.04, 1e-12);
    }
    if (samples.points[i][0] > 0.5 + margin) {
      EXPECT_NEAR(length[i], 0.01, 1e-12);
    }
    EXPECT_GE(length[i], 0.01 - 1e-12);
    EXPECT_LE(length[i], 0.04 + 1e-12);
  }
}

// Every tenth sample scatters a hundred times as much as the others, whose residuals fall by half a
// sigma from the first trial to the second. To take up scatter costs 2 sigma^2 times the leverages'
// difference, 2 (0.059 - 0.016) = 0.09 sigma^2 of theirs, which gain 0.75 sigma^2; evenly counted
// the tenth would cost 0.1 * 1e4 * 0.09 sigma^2 = 90 sigma^2. With s = 1 / 0.901 they count 1.2e-4.
TEST(LocalSmoothing, IsNotDrownedByFewThatScatterWidely) {
  Samples samples = unit_square(100, 1e-3);
  std::vector<double> before, after;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    if (i % 10 == i / 100 % 10) samples.sigma[i] = 0.1;
    before.push_back(samples.sigma[i]);
    after.push_back(samples.sigma[i] < 0.1 ? 0.5e-3 : 0.1);
  }
  LocalSmoothing smoothing(samples);
  smoothing.judge(0.035, before, all_trusted(samples));
  EXPECT_EQ(smoothing.judge(0.0175, after, all_trusted(samples)), 1);
}

// Whether a trial is taken over a square of samples whose squared residuals fall by `gain`, or grow
// by it where it is negative; of the samples from x = 0.8 on.
double share_taken(const Samples& samples, const std::vector<double>& gain) {
  std::vector<double> before, after;
  for (const double g : gain) {
    before.push_back(std::sqrt(std::max(g, 0.0)));
    after.push_back(std::sqrt(std::max(-g, 0.0)));
  }
  LocalSmoothing smoothing(samples);
  smoothing.judge(0.035, before, all_trusted(samples));
  smoothing.judge(0.0175, after, all_trusted(samples));
  double taken = 0, count = 0;
  const std::vector<double> lengths = smoothing.lengths();
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (samples.points[i][0] > 0.8) {
      taken += lengths[i] < 0.02;
      count += 1;
    }
  return taken / count;
}

// Where every second sample scatters three times as much, 1 / s is the mean of 1 and 1/3: they
// count (1.5 / 3)^2 = 1/4, the others fully, and outweigh them from four times the gain on. Those
// of the larger half of the square, ten times as sharp, change nothing: s is that of samples
// around.
TEST(LocalSmoothing, CountsBySquaredShareOfTheScatterAround) {
  Samples samples = unit_square(100, 1e-3);
  for (std::size_t i = 0; i < samples.points.size(); ++i)
    if (samples.points[i][0] > 0.55) samples.sigma[i] = (i + i / 100) % 2 ? 1e-2 : 3e-2;
  for (const auto& [ratio, taken] : {std::pair(3, 1), {5, 0}}) {
    std::vector<double> gain;  // so large that what scatter costs is not seen
    for (const double sigma : samples.sigma) gain.push_back(sigma > 2e-2 ? -ratio : 1);
    EXPECT_EQ(share_taken(samples, gain), taken) << ratio;
  }
}

// Every tenth sample says that it is exact: it counts fully, no more, and as if its sigma were a
// tenth of the median. 1 / s is the mean of one 10 and nine 1, so that the others count (1
// / 1.9)^2; from nine times that, 2.5, of their gain on the tenth outweighs them.
TEST(LocalSmoothing, LeavesASayBesideSamplesThatAreAllTooSure) {
  Samples samples = unit_square(100, 1e-3);
  for (std::size_t i = 0; i < samples.points.size(); ++i)
    if (i % 10 == i / 100 % 10) samples.sigma[i] = 1e-12;
  for (const auto& [ratio, taken] : {std::pair(2, 1), {3, 0}}) {
    std::vector<double> gain;
    for (const double sigma : samples.sigma) gain.push_back(sigma < 1e-6 ? -ratio : 1);
    EXPECT_EQ(share_taken(samples, gain), taken) << ratio;
  }
}

// Exact ones, if they are most, have all the say; if all are, they count alike.
TEST(LocalSmoothing, GoesByTheExactSamplesIfTheyAreMost) {
  Samples samples = unit_square(100, 0);
  std::vector<double> gain(samples.points.size(), 1.0);
  EXPECT_EQ(share_taken(samples, gain), 1);
  EXPECT_EQ(share_taken(samples, std::vector<double>(gain.size(), -1.0)), 0);
  for (std::size_t i = 0; i < gain.size(); ++i)
    if (i % 10 == i / 100 % 10) samples.sigma[i] = 1e-3, gain[i] = -100;
  EXPECT_EQ(share_taken(samples, gain), 1);
}

// What a region's own samples say by chance does not decide over a length that spans many regions:
// one stripe (regions are 0.071 wide) that a trial makes worse, as much as its two neighbours gain,
// keeps the old length if the trial is short and takes the new one if it is long.
TEST(LocalSmoothing, WeighsALongTrialOverItsReach) {
  const Samples samples = unit_square(100, 1e-3);
  const auto length_in_stripe = [&](double first, double second) {
    LocalSmoothing smoothing(samples);
    smoothing.judge(first, std::vector<double>(samples.points.size(), 1.0), all_trusted(samples));
    std::vector<double> residuals;
    for (const auto& u : samples.points)
      residuals.push_back(u[0] > 0.4949 && u[0] < 0.5656 ? 1.6 : 0.5);
    smoothing.judge(second, residuals, all_trusted(samples));
    double sum = 0, count = 0;
    const std::vector<double> lengths = smoothing.lengths();
    for (std::size_t i = 0; i < lengths.size(); ++i)
      if (samples.points[i][0] > 0.52 && samples.points[i][0] < 0.54) {
        sum += lengths[i];
        ++count;
      }
    return sum / count;
  };
  EXPECT_GT(length_in_stripe(0.02, 0.01), 0.012);
  EXPECT_NEAR(length_in_stripe(0.4, 0.2), 0.2, 1e-9);
}

// A fit that moves the surface by half a sigma to one side is worse for every region, however much
// nearer to the samples of that side: a region holds both sides.
TEST(LocalSmoothing, DoesNotJudgeByOneSideOfTheScatter) {
  const double sigma = 0.05;  // five spacings
  Samples samples = unit_square(100, sigma);
  std::vector<double> residuals, moved;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    RandomStream random(1, 0, i);
    residuals.push_back(sigma * random.normal());
    moved.push_back(residuals.back() - sigma / 2);
    samples.points[i][2] += residuals.back();
  }
  LocalSmoothing smoothing(samples);
  smoothing.judge(0.04, residuals, all_trusted(samples));
  EXPECT_EQ(smoothing.judge(0.02, moved, all_trusted(samples)), 0);
}

// Samples that are not trusted do not ask for a length that follows them.
TEST(LocalSmoothing, DoesNotFollowUntrustedSamples) {
  const Samples samples = unit_square(50, 1e-3);
  std::vector<double> off(2500, 1e-3), on(2500, 1e-3), trust(2500, 1.0);
  for (std::size_t i = 0; i < 2500; i += 10) off[i] = 1, trust[i] = 1e-12;
  LocalSmoothing smoothing(samples);
  smoothing.judge(0.1, off, trust);
  EXPECT_EQ(smoothing.judge(0.05, on, trust), 0);
}

TEST(LocalSmoothing, AveragesSizesAround) {
  const Samples samples = unit_square(50, 1e-3);
  const LocalSmoothing smoothing(samples);
  std::vector<double> values(2500);
  for (std::size_t i = 0; i < 2500; ++i) values[i] = i % 2 == 0 ? 3 : -3;
  for (const double mean : smoothing.mean_around(values)) EXPECT_NEAR(mean, 3, 1e-12);
}

// Regions are sqrt(50 / 10000) wide, and each sum reaches one of them farther.
TEST(LocalSmoothing, TellsWhereSumsArePositive) {
  const Samples samples = unit_square(100, 1e-3);
  const LocalSmoothing smoothing(samples);
  std::vector<double> values;
  for (std::size_t i = 0; i < samples.points.size(); ++i)
    values.push_back((samples.points[i][0] < 0.5 ? -1 : 1) + (i % 2 == 0 ? 3 : -3));
  const std::vector<char> is_positive = smoothing.are_positive_around(values);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (const double x = samples.points[i][0] - 0.5; std::abs(x) > 2 * std::sqrt(50e-4)) {
      EXPECT_EQ(is_positive[i] != 0, x > 0);
    }
}

TEST(LocalSmoothing, TellsHowManySamplesFaredBetter) {
  const Samples samples = unit_square(50, 1e-3);
  LocalSmoothing smoothing(samples);
  EXPECT_EQ(smoothing.judge(0.1, std::vector<double>(2500, 1e-3), all_trusted(samples)), 1);
  EXPECT_EQ(smoothing.judge(0.05, std::vector<double>(2500, 1e-3), all_trusted(samples)), 0);
  EXPECT_EQ(smoothing.judge(0.02, std::vector<double>(2500, 1e-6), all_trusted(samples)), 1);
}

}  // namespace
}  // namespace scan
