// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a model of a study draws.
#include "tools/study_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace scan {
namespace {

// Ten runs of a surface without interactions or chance in 6 x 6 settings: what was seen is drawn as
// it is, and what was not lies within the scatter that the drawings tell (six sigma of 26).
TEST(StudyModel, DrawsWhatItSawAndTellsHowFarItMayBeOff) {
  const nlohmann::json json =
      nlohmann::json::parse(R"({"vary": [{"key": "a", "values": [1, 2, 3, 4, 5, 6]},
      {"key": "b", "values": [1, 2, 3, 4, 5, 6]}], "seeds": 1})");
  const Study study = read_study(JsonReader(json, "test"));
  const auto value = [](std::size_t place) {
    return -0.5 * static_cast<double>(place / 6) - 0.3 * static_cast<double>(place % 6);
  };
  std::vector<StudyObservation> seen;
  for (const std::size_t place : {0, 5, 30, 35, 14, 21, 9, 26, 19, 10})
    seen.push_back({place, 0, value(place)});
  StudyModel model(study);
  model.fit(seen);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(36), squares = sum;
  constexpr int count = 200;
  for (std::uint32_t i = 0; i < count; ++i) {
    RandomStream random(5, i, 0);
    const Eigen::VectorXd drawn = model.draw(random);
    for (const StudyObservation& o : seen)
      EXPECT_NEAR(drawn(static_cast<Eigen::Index>(o.place)), o.log_value, 1e-6);
    sum += drawn;
    squares += drawn.cwiseAbs2();
  }
  for (std::size_t place = 0; place < 36; ++place) {
    const auto at = static_cast<Eigen::Index>(place);
    const double mean = sum(at) / count;
    const double sigma = std::sqrt(std::max(0.0, squares(at) / count - mean * mean));
    EXPECT_NEAR(mean, value(place), 6 * sigma + 1e-6) << place;
    EXPECT_LT(sigma, 0.996) << place;  // the values' own: who knows nothing tells no less
  }
}

// Three words by five numbers by two words with three seeds, some settings run with one, some with
// all. Drawings scatter as variances() says, times one scale for all: of 1000 drawings a variance
// is right to 4.5 %, four of which are 18 %; where all seeds ran nothing is left to scatter.
TEST(StudyModel, DrawsScatterAsItsVariancesSay) {
  const nlohmann::json json =
      nlohmann::json::parse(R"({"vary": [{"key": "a", "values": ["p", "q", "r"]},
      {"key": "b", "values": [1, 2, 3, 4, 5]}, {"key": "c", "values": ["s", "t"]}], "seeds": 3})");
  const Study study = read_study(JsonReader(json, "test"));
  const std::size_t settings = grid(study).size();
  ASSERT_EQ(settings, 30u);
  StudyModel model(study);
  RandomStream noise(8, 0, 0);
  std::vector<StudyObservation> seen;
  std::vector<double> sums(settings, 0);
  for (const std::size_t place : {0, 1, 7, 13, 18, 22, 29})
    for (int seed = 0; seed < (place % 2 ? 1 : 3); ++seed) {
      const double of_seed = noise.normal(), of_run = noise.normal();
      seen.push_back(
          {place, seed,
           double(place / 10) + 0.3 * double(place % 10) + 0.4 * of_seed + 0.2 * of_run});
      sums[place] += seen.back().log_value;
    }
  model.fit(seen);
  const Eigen::VectorXd stated = model.variances();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(30), squares = sum;
  constexpr int count = 1000;
  for (std::uint32_t i = 0; i < count; ++i) {
    RandomStream random(6, i, 0);
    const Eigen::VectorXd drawn = model.draw(random);
    sum += drawn;
    squares += drawn.cwiseAbs2();
  }
  const Eigen::VectorXd found = squares / count - (sum / count).cwiseAbs2();
  double scale2 = 0;
  for (Eigen::Index i = 0; i < 30; ++i) scale2 += found(i) / stated.sum();
  ASSERT_GT(scale2, 0);
  for (Eigen::Index i = 0; i < 30; ++i)
    if (const auto place = std::size_t(i); sums[place] != 0 && place % 2 == 0) {
      EXPECT_LT(stated(i), 1e-9 * stated.maxCoeff()) << place;
      EXPECT_NEAR(sum(i) / count, sums[place] / 3, 1e-6) << place;
    } else {
      EXPECT_NEAR(found(i) / (scale2 * stated(i)), 1, 0.18 + 0.02) << place;  // and of the scale
    }
}

// Of two fields of four words one alone tells, and each of its words ran twice: then the other runs
// of these words are known, too. A model that goes on to hold both fields for equal is left with
// 0.24 of the variance that it began with.
TEST(StudyModel, LearnsWhichFieldTells) {
  const nlohmann::json json = nlohmann::json::parse(R"({"vary": [
      {"key": "a", "values": ["p", "q", "r", "s"]},
      {"key": "b", "values": ["t", "u", "v", "w"]}], "seeds": 1})");
  StudyModel model(read_study(JsonReader(json, "test")));
  const Eigen::VectorXd before = model.variances();
  std::vector<StudyObservation> seen;
  for (const std::size_t a : {0, 1, 2, 3})
    for (const std::size_t b : {a, (a + 1) % 4}) seen.push_back({4 * a + b, 0, std::pow(2.0, a)});
  model.fit(seen);
  const Eigen::VectorXd after = model.variances();
  for (const std::size_t a : {0, 1, 2, 3})
    for (const std::size_t b : {(a + 2) % 4, (a + 3) % 4}) {
      const auto at = static_cast<Eigen::Index>(4 * a + b);
      EXPECT_LT(after(at), 0.1 * before(at)) << at;
    }
}

}  // namespace
}  // namespace scan
