// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Numbers beside the places that they mark.
#include "tools/report/svg.h"

#include <gtest/gtest.h>

namespace scan {
namespace {

// Three discs of radius r around places that nearly coincide find room on a circle of radius 22 px,
// whose eighths are 2 * 22 sin(22.5 deg) = 16.8 px apart, every other one 31 px, so more than 2 r.
TEST(BadgePlaces, OfNeighboursCoverNeitherEachOtherNorTheRim) {
  for (const double x : {160.0, 250.0, 315.0}) {
    const std::vector<Eigen::Vector2d> places = {{x, 160}, {x + 2, 161}, {x - 2, 158}};
    const auto badges = badge_places(places, 320);
    ASSERT_EQ(badges.size(), places.size());
    for (std::size_t i = 0; i < badges.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GE((badges[i] - badges[j]).norm(), 2 * badge_radius_px) << i << ", " << j;
      EXPECT_GE(badges[i].minCoeff(), badge_radius_px);
      EXPECT_LE(badges[i].maxCoeff(), 320 - badge_radius_px);
    }
  }
}

TEST(BadgePlaces, OfALonelyPlacePointsAwayFromTheMiddle) {
  const std::vector<Eigen::Vector2d> places = {{200, 160}, {100, 100}};
  const auto badges = badge_places(places, 320);
  EXPECT_NEAR((badges[0] - Eigen::Vector2d(222, 160)).norm(), 0, 1e-12);
  EXPECT_LT(badges[1].x(), 100);
  EXPECT_LT(badges[1].y(), 100);
}

}  // namespace
}  // namespace scan
