// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/estimate.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "libscan/core/error.h"
#include "libscan/core/random.h"

namespace scan::synth {
namespace {

// One RandomStream per stream and trial.
class Streams {
 public:
  explicit Streams(std::uint64_t trial) {
    for (std::uint64_t k = 0; k < 4; ++k) streams_.emplace_back(7, k, trial);
  }
  RandomStream& operator[](int stream) { return streams_[stream]; }

 private:
  std::vector<RandomStream> streams_;
};

const auto unit_noise = [](double) { return 1.0; };

SamplingGoal exactly(int samples) {
  return {.share_of_noise = 0, .least_samples = samples, .most_samples = samples};
}

// Student's t with 3 degrees of freedom.
double student_3_below(double t) {
  const double s = t / std::sqrt(3.0);
  return 0.5 + (s / (1 + s * s) + std::atan(s)) / std::numbers::pi;
}

// The integrals of x, x^2 and exp(x) over [0, 1] are 1/2, 1/3, e - 1. 1000 estimates of 64 samples:
// the mean of all has the standard deviation of the integrand over sqrt(64000); 4.5 of them are
// passed by chance once in 150 000 seeds.
TEST(Estimate, IsUnbiased) {
  const std::array<double, 3> truth = {0.5, 1.0 / 3, std::numbers::e - 1};
  const std::array<double, 3> deviation = {
      std::sqrt(1.0 / 12), std::sqrt(1.0 / 5 - 1.0 / 9),
      std::sqrt((std::pow(std::numbers::e, 2) - 1) / 2 - std::pow(std::numbers::e - 1, 2))};
  std::array<double, 3> sum = {};
  const int trials = 1000;
  for (int trial = 0; trial < trials; ++trial) {
    Streams random(trial);
    const Estimate found =
        estimate(3, exactly(64), unit_noise, [&](int stream, int, std::span<double> signals) {
          const double x = random[stream].uniform();
          signals[0] += x;
          signals[1] += x * x;
          signals[2] += std::exp(x);
        });
    EXPECT_EQ(found.samples, 64);
    for (int s = 0; s < 3; ++s) sum[s] += found.mean[s];
  }
  for (int s = 0; s < 3; ++s)
    EXPECT_NEAR(sum[s] / trials, truth[s], 4.5 * deviation[s] / std::sqrt(64.0 * trials)) << s;
}

// Of normal samples the error over the stated standard error is exactly Student's t with 3 degrees
// of freedom: 20 bins of equal probability, chi-square with 19 degrees of freedom passes 50.8 once
// in 10 000 seeds.
TEST(Estimate, StandardErrorIsCalibrated) {
  const int trials = 20000, bins = 20;
  std::array<int, 20> counts = {};
  for (int trial = 0; trial < trials; ++trial) {
    Streams random(trial);
    const Estimate found =
        estimate(1, exactly(16), unit_noise, [&](int stream, int, std::span<double> signals) {
          signals[0] += 3 + 0.7 * random[stream].normal();
        });
    const double below = student_3_below((found.mean[0] - 3) / found.standard_error[0]);
    ++counts[std::min(bins - 1, static_cast<int>(below * bins))];
  }
  double chi2 = 0;
  const double expected = static_cast<double>(trials) / bins;
  for (const int count : counts) chi2 += (count - expected) * (count - expected) / expected;
  EXPECT_LT(chi2, 50.8);
}

// Only sample 0 of each stream differs: stream k adds k, so after n per stream its mean is k / n.
// Without stream 0 or 3 the others' variance is 1 / n^2, without 1 or 2 it is 7/3 / n^2; half its
// root is the standard error of four. With a share of exactly 1/2 over n, streams 0 and 3 take
// their means at n, the other two at 2 n.
TEST(Estimate, StopsWhereTheOthersAreGoodEnough) {
  const auto draw = [](int stream, int index, std::span<double> signals) {
    if (index == 0) signals[0] += stream;
  };
  for (const int n : {1, 2, 8, 64}) {
    const double share = 0.5 / n * (1 + 1e-12);
    const Estimate found = estimate(
        1, {.share_of_noise = share, .least_samples = 4, .most_samples = 4096}, unit_noise, draw);
    EXPECT_EQ(found.samples, 4 * 2 * n);
    const std::array<double, 4> means = {0, 0.5 / n, 1.0 / n, 3.0 / n};
    const double mean = 1.125 / n;
    double scatter = 0;
    for (const double m : means) scatter += (m - mean) * (m - mean);
    EXPECT_NEAR(found.mean[0], mean, 1e-15);
    EXPECT_NEAR(found.standard_error[0], std::sqrt(scatter / 12), 1e-15);
  }
}

// One sample in ten is 10, the others 0: by its own spread a mean would stop early whenever it
// misses the bright ones, and be low by a fifth. 4.5 standard errors, found from the estimates
// themselves.
TEST(Estimate, IsUnbiasedThoughItStopsEarly) {
  const int trials = 20000;
  double sum = 0, sum2 = 0, samples = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Streams random(trial);
    const Estimate found = estimate(
        1, {}, [](double) { return 2.0; },
        [&](int stream, int, std::span<double> signals) {
          if (random[stream].uniform() < 0.1) signals[0] += 10;
        });
    sum += found.mean[0];
    sum2 += found.mean[0] * found.mean[0];
    samples += found.samples;
  }
  const double mean = sum / trials;
  EXPECT_NEAR(mean, 1, 4.5 * std::sqrt((sum2 / trials - mean * mean) / trials));
  EXPECT_LT(samples / trials, 512);  // it does stop early
}

TEST(Estimate, EverySignalHasToBeGoodEnough) {
  const auto draw = [](int stream, int index, std::span<double> signals) {
    signals[0] += 1;
    if (index == 0) signals[1] += stream;
  };
  const SamplingGoal goal{.share_of_noise = 0.1, .least_samples = 4, .most_samples = 1024};
  // sqrt(7/3) / 2 / n <= 0.1 from n = 8 on, and so is 1 / 2 / n
  EXPECT_EQ(estimate(2, goal, unit_noise, draw).samples, 32);
  // the noise is that of the signal's own mean: 0.1 * 10 passes at once
  EXPECT_EQ(estimate(
                2, goal, [](double) { return 10.0; }, draw)
                .samples,
            4);
}

TEST(Estimate, DrawsEachSampleOnceAndNeverMoreThanAllowed) {
  std::vector<std::array<int, 4>> drawn(64);
  const Estimate found =
      estimate(1, {.share_of_noise = 0, .least_samples = 12, .most_samples = 102}, unit_noise,
               [&](int stream, int index, std::span<double> signals) {
                 ++drawn.at(index)[stream];
                 signals[0] += stream;
               });
  EXPECT_EQ(found.samples, 100);  // 102 is no multiple of four
  for (int index = 0; index < 64; ++index)
    for (int k = 0; k < 4; ++k) EXPECT_EQ(drawn[index][k], index < 25 ? 1 : 0);
}

TEST(Estimate, OfDarknessNeedsTheLeast) {
  const Estimate found = estimate(2, {}, unit_noise, [](int, int, std::span<double>) {});
  EXPECT_EQ(found.samples, 16);
  EXPECT_EQ(found.mean, std::vector<double>(2, 0));
  EXPECT_EQ(found.standard_error, std::vector<double>(2, 0));
}

TEST(Estimate, OfNoSignalsDrawsNothing) {
  const Estimate found =
      estimate(0, {}, unit_noise, [](int, int, std::span<double>) { FAIL() << "drawn"; });
  EXPECT_EQ(found.samples, 0);
  EXPECT_TRUE(found.mean.empty());
}

TEST(Estimate, ReusedMemoryGivesTheSame) {
  EstimateMemory memory;
  Estimate again;
  for (int trial = 0; trial < 3; ++trial) {
    const std::size_t signals = 3 - trial;
    const auto run = [&](auto&&... reused) {
      Streams random(trial);
      return estimate(
          signals, exactly(32), unit_noise,
          [&](int stream, int, std::span<double> sums) {
            for (double& sum : sums) sum += random[stream].uniform();
          },
          reused...);
    };
    const Estimate fresh = run();
    run(memory, again);
    EXPECT_EQ(fresh.mean, again.mean);
    EXPECT_EQ(fresh.standard_error, again.standard_error);
  }
}

TEST(SamplingGoal, NamesWhatIsWrong) {
  EXPECT_NO_THROW(check(SamplingGoal{}));
  EXPECT_THROW(check(SamplingGoal{.share_of_noise = -1}), Error);
  EXPECT_THROW(check(SamplingGoal{.share_of_noise = std::nan("")}), Error);
  EXPECT_THROW(check(SamplingGoal{.least_samples = 6}), Error);
  EXPECT_THROW(check(SamplingGoal{.least_samples = 0}), Error);
  EXPECT_THROW(check(SamplingGoal{.least_samples = 16, .most_samples = 8}), Error);
}

}  // namespace
}  // namespace scan::synth
