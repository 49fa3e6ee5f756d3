// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Numbers beside the places that they mark.
#include "tools/report/svg.h"

#include <gtest/gtest.h>

#include <string>

namespace scan {
namespace {

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// The scale goes from 16 to 744 px in five marks; one bin fills it, white as its middle is 0.
TEST(HistogramPlot, PutsMarksAndBarsInTheirPlaces) {
  const std::string svg =
      histogram_plot({.limit_m = 1e-3, .counts = {5}, .below = 1, .above = 4}, {});
  for (const char* x : {"16.0", "198.0", "380.0", "562.0", "744.0"})
    EXPECT_TRUE(holds(svg, std::string("<line class='axis' x1='") + x + "' y1='222.0'")) << x;
  EXPECT_TRUE(holds(svg, "x='16.00' y='40.00' width='728.00' height='182.00' fill='#f7f7f7'"))
      << svg;
  EXPECT_TRUE(holds(svg, "of 10 vertices; 50.00 % lie beyond the scale")) << svg;
}

// At half of the scale a limit's lines are at a quarter and three quarters of the plot.
TEST(HistogramPlot, DrawsTheLimitsThatLieOnItsScale) {
  const DeviationHistogram histogram{.limit_m = 1e-3, .counts = {1, 1}};
  const std::string svg = histogram_plot(histogram, {{"half", 5e-4}, {"far", 1.1e-3}});
  EXPECT_TRUE(holds(svg, "<line class='limit' x1='198.0'")) << svg;
  EXPECT_TRUE(holds(svg, "<line class='limit' x1='562.0'")) << svg;
  EXPECT_TRUE(holds(svg, ">half 500")) << svg;
  EXPECT_FALSE(holds(svg, ">far ")) << svg;
}

// The whole limit is 100 of 125, and what is beyond it ends there.
TEST(LimitBar, ShowsWhatIsUsed) {
  EXPECT_TRUE(holds(limit_bar(0.5, true), "class='good' width='50.0'"));
  EXPECT_TRUE(holds(limit_bar(1.2, false), "class='bad' width='120.0'"));
  EXPECT_TRUE(holds(limit_bar(3, false), "class='bad' width='125.0'"));
  EXPECT_TRUE(holds(limit_bar(3, false), "300 percent"));
}

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
