// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What an alignment says of its own uncertainty, against its errors over many simulated pairs.
#include <gtest/gtest.h>

#include "libscan/core/parallel.h"
#include "tests/align/icp_methods.h"
#include "tests/align/simulated_pairs.h"

namespace scan {
namespace {

// Mean of e^T I e / 6 over pairs of different surfaces; of few of them the waves all run one way,
// and leave a motion open.
double mean_error2(IcpMethod method, test::ScannerNoise noise, std::size_t pairs) {
  std::vector<double> errors2(pairs);
  parallel_for(
      pairs,
      [&](std::size_t i) {
        const test::SimulatedPair pair = test::simulated_pair(noise, 100, i + 1);
        const IcpResult result = icp(pair.source, pair.target, pair.guess, {.method = method});
        errors2[i] =
            result.stop == Stop::converged ? test::normalised_error2(result, pair.truth) / 6 : -1;
      },
      1);
  std::erase(errors2, -1);
  EXPECT_GE(errors2.size(), pairs * 9 / 10);
  double sum = 0;
  for (const double error2 : errors2) sum += error2;
  return sum / static_cast<double>(errors2.size());
}

class PoseInformation : public testing::TestWithParam<test::ScannerNoise> {};
INSTANTIATE_TEST_SUITE_P(EveryScanner, PoseInformation, testing::ValuesIn(test::scanner_noises),
                         [](const auto& noise) {
                           std::string name = test::name_of(noise.param);
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

// Chi-square with six degrees of freedom over six varies by 1 / 3, the estimate of the noise that
// neighbours share by a tenth: the mean over 60 pairs by 0.087, of which three; a tenth of bias is
// allowed. Taking all pairs for independent would give 1.35 where points err alone, 4 on laser
// lines and 16 where neighbours err together.
TEST_P(PoseInformation, TellsTheErrorThatThereIs) {
  const double mean = mean_error2(IcpMethod::symmetric, GetParam(), 60);
  RecordProperty("mean_error2", std::to_string(mean));
  EXPECT_NEAR(mean, 1, 0.1 + 3 * 0.087);
}

// Where noise is half of the spacing the nearest points hide four tenths of a motion across the
// surface (PairFinder::shown_share): without that the mean is 2.7. The estimates' own scatter makes
// it vary by 0.103 over 60 pairs, of which three. Such noise leaves some motions weak: then fewer
// degrees of freedom are told.
TEST(PoseInformationOfNoisyScans, CountsWhatTheChoiceOfPartnersHides) {
  constexpr std::size_t pairs = 60;
  std::vector<double> errors2(pairs);
  parallel_for(
      pairs,
      [&](std::size_t i) {
        const test::SimulatedPair pair =
            test::simulated_pair(test::ScannerNoise::lidar, 50, i + 1, 0.5);
        const IcpResult result = icp(pair.source, pair.target, pair.guess);
        const auto told = 6 - static_cast<double>(result.weak_directions.size());
        errors2[i] = test::normalised_error2(result, pair.truth) / told;
      },
      1);
  double mean = 0;
  for (const double error2 : errors2) mean += error2 / pairs;
  RecordProperty("mean_error2", std::to_string(mean));
  EXPECT_NEAR(mean, 1, 0.1 + 3 * 0.103);
}

// Along what is weak it is zero, elsewhere positive.
TEST(PoseInformationOfACorridor, IsZeroAlongIt) {
  const auto noisy = [](std::uint64_t seed) {
    PointCloud cloud = test::bumpy_surface(0, 0);
    for (int i = 0; i < 8000; ++i) {
      RandomStream random(seed, 9, std::uint64_t(i));
      const double x = 20 * random.uniform() - 10, u = 2 * random.uniform() - 1;
      const std::uint32_t side = random.bits32() % 2;
      const double error_m = 0.01 * random.normal();
      cloud.points.push_back(side ? Eigen::Vector3d(x, u, 1 + error_m)
                                  : Eigen::Vector3d(x, 1 + error_m, u));
    }
    return cloud;
  };
  const IcpResult result = icp(noisy(1), noisy(2), Pose(Eigen::Translation3d(0.3, 0.02, 0.01)));
  ASSERT_EQ(result.stop, Stop::degenerate);
  const Matrix6& information = result.information;
  // The free direction leans from x as the start does, by the ratio of what is fixed to the length.
  EXPECT_LT(information(3, 3), 1e-4 * information(4, 4));
  for (const int i : {0, 1, 2, 4, 5}) EXPECT_GT(information(i, i), 0);
}

}  // namespace
}  // namespace scan
