// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/picture.h"

#include <gtest/gtest.h>

#include "tools/report/colour_map.h"

namespace scan {
namespace {

// A square of 1 m in the x-z plane, facing -y, of two triangles; the value is 2 max(x, z) - 1, with
// a bend between the triangles.
struct Ramp {
  Mesh mesh = {{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  std::vector<double> values = {-1, 1, 1, 1};
};

// Seen from the front; the shading of a face that looks at the viewer is 1.
TEST(Portrait, ColourEachPlaceByItsOwnValue) {
  const Ramp ramp;
  constexpr int size_px = 100;
  const View front = Portrait(ramp.mesh, ramp.values, 1).six_views(size_px).front();
  const double pixel_m = 1.08 / size_px;
  for (const int row : {15, 50, 85})
    for (int column = 6; column < 94; column += 8) {
      const double x = 0.5 + (column + 0.5 - size_px / 2.0) * pixel_m;
      const double z = 0.5 - (row + 0.5 - size_px / 2.0) * pixel_m;
      const Colour expected = diverging_colour(2 * std::max(x, z) - 1);
      for (int channel = 0; channel < 3; ++channel)  // four sub-rays average a gentle gradient
        EXPECT_NEAR(front.image(column, row)[channel], expected[channel], 2)
            << column << " " << row;
    }
}

TEST(Portrait, LeaveTheBackgroundWhite) {
  const Ramp ramp;
  const View front = Portrait(ramp.mesh, ramp.values, 1).six_views(100).front();
  EXPECT_EQ(front.image(0, 0), (Colour{255, 255, 255}));
}

TEST(DeviationLimit, HoldsNinetyNineOfAHundred) {
  std::vector<double> deviations;
  for (int i = 1; i <= 100; ++i) deviations.push_back(i % 2 ? i : -i);
  EXPECT_EQ(deviation_limit_m(deviations), 99);
  EXPECT_EQ(deviation_limit_m({}), 1);
}

TEST(DivergingColour, IsWhiteAtZeroAndGreyWithoutData) {
  EXPECT_EQ(diverging_colour(0), (Colour{247, 247, 247}));
  EXPECT_EQ(diverging_colour(-2), (Colour{33, 102, 172}));
  EXPECT_EQ(diverging_colour(1), (Colour{178, 24, 43}));
  EXPECT_EQ(diverging_colour(std::numeric_limits<double>::quiet_NaN()), (Colour{150, 150, 150}));
}

}  // namespace
}  // namespace scan
