// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Disparity images of a few pixels, counted by hand.
#include "libscan/verify/disparity_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libscan/core/error.h"
#include "tests/verify/figure.h"

namespace scan {
namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

Image<float> image(std::vector<float> pixels) {
  Image<float> result(static_cast<int>(pixels.size()), 1);
  result.pixels = std::move(pixels);
  return result;
}

// Known truth at five pixels; four of them matched with errors 0, 2 (not bad), 3 (bad), 1.
TEST(DisparityError, CountsByHand) {
  const auto truth = image({10, 20, 30, 40, unknown, 50});
  const auto measured = image({10, 22, 27, unknown, 7, 51});
  const auto figures = disparity_error(measured, truth, 10);
  EXPECT_DOUBLE_EQ(figure(figures, "disparity_bad_2px"), 1.0 / 4);
  EXPECT_DOUBLE_EQ(figure(figures, "disparity_bad_2px_all"), 2.0 / 5);
  EXPECT_DOUBLE_EQ(figure(figures, "disparity_density"), 4.0 / 5);
  EXPECT_DOUBLE_EQ(figure(figures, "disparity_error_median"), 1);
  // relative depth errors: 0, 30/32 - 1, 40/37 - 1, 60/61 - 1; the second smallest is 1/61
  EXPECT_NEAR(figure(figures, "relative_depth_error_median"), 1.0 / 61, 1e-15);
  EXPECT_EQ(measurement(figures, "disparity_bad_2px_all").count, 5u);
}

TEST(DisparityError, OfAPerfectMatchIsZero) {
  const auto truth = image({1, 2, unknown, 4});
  const auto figures = disparity_error(truth, truth, 0);
  EXPECT_EQ(figure(figures, "disparity_bad_2px_all"), 0);
  EXPECT_EQ(figure(figures, "disparity_density"), 1);
  EXPECT_EQ(figure(figures, "relative_depth_error_median"), 0);
}

TEST(DisparityError, OfNoMatchAtAllIsAllBad) {
  const auto figures = disparity_error(image({unknown, unknown}), image({3, 4}), 0);
  EXPECT_EQ(figure(figures, "disparity_bad_2px_all"), 1);
  EXPECT_EQ(figure(figures, "disparity_density"), 0);
  EXPECT_TRUE(std::isnan(figure(figures, "disparity_bad_2px")));
}

TEST(DisparityError, OfAPointAtInfinityHasNoDepth) {
  const auto at_infinity = disparity_error(image({-10}), image({-10}), 10);
  EXPECT_TRUE(std::isinf(figure(at_infinity, "relative_depth_error_median")));
  const auto behind = disparity_error(image({-11}), image({3}), 10);
  EXPECT_TRUE(std::isinf(figure(behind, "relative_depth_error_median")));
}

TEST(DisparityError, TreatsInfinityAsUnknown) {
  const float infinity = std::numeric_limits<float>::infinity();
  const auto figures = disparity_error(image({3, 4}), image({3, infinity}), 0);
  EXPECT_EQ(measurement(figures, "disparity_density").count, 1u);
}

TEST(DisparityError, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(disparity_error(image({1}), image({1, 2}), 0), Error);
  EXPECT_THROW(disparity_error(image({1}), image({unknown}), 0), Error);
}

}  // namespace
}  // namespace scan
