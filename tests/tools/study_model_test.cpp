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

}  // namespace
}  // namespace scan
