// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/block_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "libscan/core/random_blocks.h"
#include "tests/core/chi_square.h"

namespace scan::synth {
namespace {

constexpr DetectorEffects shot_alone{.shot_noise = true, .read_noise = false, .quantisation = true};

double below(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

// P(electrons < limit) of Poisson's number and Gaussian noise, summed over the counts within 13
// standard deviations and 40.
double probability_below(double mean_e, double read_e, double limit_e) {
  const double reach = 13 * std::sqrt(mean_e) + 40;
  double sum = 0;
  for (double k = std::max(0.0, std::floor(mean_e - reach)); k < mean_e + reach; ++k) {
    const double log_p =
        mean_e > 0 ? k * std::log(mean_e) - mean_e - std::lgamma(k + 1) : (k == 0 ? 0.0 : -1e9);
    const double share = read_e > 0 ? below((limit_e - k) / read_e) : (k < limit_e ? 1.0 : 0.0);
    sum += std::exp(log_p) * share;
  }
  return sum;
}

std::uint16_t reading(const BlockDetector& detector, double mean_e, float normal) {
  std::uint16_t result = 0;
  detector.read({&mean_e, 1}, {&normal, 1}, {&result, 1}, [](std::size_t) -> std::uint16_t {
    ADD_FAILURE() << "the closed form should hold";
    return 0;
  });
  return result;
}

// The normal number at which readings step beyond `dn`.
double step_beyond(const BlockDetector& detector, double mean_e, int dn) {
  float low = -8, high = 8;
  for (int i = 0; i < 45; ++i) {
    const float middle = (low + high) / 2;
    (reading(detector, mean_e, middle) <= dn ? low : high) = middle;
  }
  return low;
}

// Largest error of P(reading <= dn) over readings within 6 standard deviations.
double largest_error(const Sensor& sensor, const DetectorEffects& effects, double mean_e) {
  const BlockDetector detector(sensor, effects);
  const double read_e = effects.read_noise ? sensor.read_noise_e : 0;
  const double spread_e = std::sqrt(mean_e + read_e * read_e);
  double worst = 0;
  for (double z = -6; z <= 6; z += 0.25) {
    const double dn = std::floor((mean_e + z * spread_e) / sensor.gain_e_per_dn + sensor.offset_dn);
    if (dn < 0) continue;
    const double limit_e = (dn + 0.5 - sensor.offset_dn) * sensor.gain_e_per_dn;
    const double is = below(step_beyond(detector, mean_e, static_cast<int>(dn)));
    worst = std::max(worst, std::abs(is - probability_below(mean_e, read_e, limit_e)));
  }
  return worst;
}

// lgamma rounds at 1e-10 for the largest means.
TEST(BlockDetector, HasTheProbabilitiesOfPoissonAndGauss) {
  for (const double read_e : {4.0, 6.0, 10.0, 30.0})
    for (const double mean_e : {0.0, 0.3, 2.0, 7.0, 12.0, 20.0, 60.0, 300.0, 2e4}) {
      const Sensor sensor{.gain_e_per_dn = 0.7, .offset_dn = 400, .read_noise_e = read_e};
      EXPECT_LT(largest_error(sensor, {}, mean_e), 1e-6) << read_e << ' ' << mean_e;
    }
  for (const double read_e : {1.0, 2.0, 3.9})
    for (const double mean_e : {50.0, 80.0, 300.0, 2e4}) {
      const Sensor sensor{.gain_e_per_dn = 1.3, .offset_dn = 400, .read_noise_e = read_e};
      EXPECT_LT(largest_error(sensor, {}, mean_e), 1e-6) << read_e << ' ' << mean_e;
    }
}

TEST(BlockDetector, CountsElectronsAsPoissonDoes) {
  for (const double gain : {1.0, 3.0})
    for (const double mean_e : {50.0, 63.7, 120.0, 800.0, 2e4})
      EXPECT_LT(largest_error({.gain_e_per_dn = gain}, shot_alone, mean_e), 1e-6) << mean_e;
}

// A million readings each by bulk normals against the exact probabilities; cells of at least 50.
TEST(BlockDetector, DrawsFromThatDistribution) {
  std::vector<BlockAddress> blocks;
  for (std::size_t i = 0; i < 250'000; ++i) blocks.push_back({i, 0});
  std::vector<float> normals(4 * blocks.size());
  draw_normals(3, 1, blocks, normals);
  struct Case {
    double read_e, mean_e;
  };
  for (const auto& [read_e, mean_e] : {Case{4, 9}, {10, 5}, {2, 70}, {0, 55}, {0, 3000}}) {
    const Sensor sensor{.gain_e_per_dn = 2, .offset_dn = 60, .read_noise_e = read_e};
    const BlockDetector detector(sensor, {});
    const std::vector<double> expected_e(normals.size(), mean_e);
    std::vector<std::uint16_t> readings(normals.size());
    detector.read(expected_e, normals, readings, [](std::size_t) { return std::uint16_t{0}; });
    std::vector<double> histogram(65536, 0), observed(1, 0), expected(1, 0);
    for (const std::uint16_t dn : readings) ++histogram[dn];
    double before = 0;
    for (int dn = 0; dn < 5000; ++dn) {
      const double up_to = probability_below(mean_e, read_e, (dn + 0.5 - 60) * 2);
      observed.back() += histogram[dn];
      expected.back() += 1e6 * (up_to - before);
      before = up_to;
      if (expected.back() < 50 || 1e6 * (1 - up_to) < 50) continue;
      observed.push_back(0);
      expected.push_back(0);
    }
    EXPECT_LT(chi_square_score(observed, expected), one_in_a_million) << read_e << ' ' << mean_e;
  }
}

// Where the closed form is not right the caller reads, and only there.
TEST(BlockDetector, AsksWhereItsFormDoesNotHold) {
  const std::vector<double> expected_e = {0, 49, 51, 900, 1100, 1e6};
  const auto asked = [&](const Sensor& sensor, const DetectorEffects& effects) {
    std::vector<std::size_t> which;
    std::vector<std::uint16_t> readings(expected_e.size());
    const std::vector<float> normals(expected_e.size(), 0.0F);
    BlockDetector(sensor, effects).read(expected_e, normals, readings, [&](std::size_t i) {
      which.push_back(i);
      return std::uint16_t{7};
    });
    for (const std::size_t i : which) EXPECT_EQ(readings[i], 7);
    return which;
  };
  using Places = std::vector<std::size_t>;
  const double well_e = 1250;  // 1000 + 8 sqrt(1000) = 1253
  EXPECT_EQ(asked({.read_noise_e = 4}, {}), Places{});
  EXPECT_EQ(asked({.read_noise_e = 1}, {}), (Places{0, 1}));
  EXPECT_EQ(asked({.read_noise_e = 0}, {}), (Places{0, 1}));
  EXPECT_EQ(asked({.read_noise_e = 0.5}, {}), (Places{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(asked({.read_noise_e = 4, .full_well_e = well_e}, {}), (Places{4, 5}));
  EXPECT_EQ(asked({.read_noise_e = 0.5, .full_well_e = well_e}, {.shot_noise = false}), Places{});
}

TEST(BlockDetector, ReadsWithoutNoiseAsTheDetectorDoes) {
  const DetectorEffects quiet{.shot_noise = false, .read_noise = false, .quantisation = true};
  for (const DetectorEffects& effects : {quiet, DetectorEffects{false, false, false}})
    for (const Sensor& sensor :
         {Sensor{.gain_e_per_dn = 3, .offset_dn = 7, .full_well_e = 9000, .bits = 12},
          Sensor{.gain_e_per_dn = 10, .offset_dn = -100, .bits = 8}}) {
      const BlockDetector detector(sensor, effects);
      EXPECT_FALSE(detector.needs_normals());
      RandomStream none(0, 0, 0);
      for (double e = -10; e < 14'000; e += 3.77) {
        const std::uint16_t dn = reading(detector, e, 0);
        ASSERT_EQ(dn, read_pixel(sensor, effects, e, none)) << e;
      }
    }
}

TEST(BlockDetector, GivesTheSameBytesByEveryKernel) {
  std::vector<BlockAddress> blocks;
  for (std::size_t i = 0; i < 2000; ++i) blocks.push_back({i, 0});
  std::vector<float> normals(4 * blocks.size() - 3), all(4 * blocks.size());
  std::vector<double> expected_e;
  draw_normals(3, 1, blocks, all);
  std::copy_n(all.begin(), normals.size(), normals.begin());
  for (std::size_t i = 0; i < normals.size(); ++i)
    expected_e.push_back(60 + 5e-4 * static_cast<double>(i * i % 100'003));
  for (const ReadingLaw::Kind kind :
       {ReadingLaw::Kind::exact, ReadingLaw::Kind::sum, ReadingLaw::Kind::count}) {
    const ReadingLaw law{.kind = kind,
                         .shot = 1,
                         .variance_e2 = kind == ReadingLaw::Kind::count ? -1.0 / 12 : 30,
                         .most_e = 1e9,
                         .high_e = 1e9,
                         .dn_per_e = 113.7,
                         .offset_dn = 0.25,
                         .largest_dn = 65535};
    std::vector<std::uint16_t> plain(normals.size()), other(normals.size());
    reading_kernels().front()(law, expected_e.data(), normals.data(), plain.data(), plain.size());
    for (ReadingKernel* const kernel : reading_kernels()) {
      EXPECT_TRUE(kernel(law, expected_e.data(), normals.data(), other.data(), other.size()));
      EXPECT_EQ(plain, other);
    }
  }
}

}  // namespace
}  // namespace scan::synth
