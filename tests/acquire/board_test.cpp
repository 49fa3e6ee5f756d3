// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/board.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "tests/acquire/stripe_pictures.h"

namespace scan {
namespace {

using test::bent_camera;
using test::held_boards;
using test::picture_of;
using test::test_board;

const std::vector<Pose>& poses() {
  static const std::vector<Pose> held = held_boards(bent_camera(), test_board, 5, 4);
  return held;
}

// The printed corners are known up to which of the two ends comes first: the finder takes the one
// whose corner square is light.
TEST(Board, CornersAreFoundToAFewHundredthsOfAPixel) {
  const Camera camera = bent_camera();
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < poses().size(); ++i) {
    const auto seen = find_board(picture_of(camera, test_board, poses()[i], 0.7, 2, i), test_board);
    ASSERT_EQ(seen.left_out, "");
    const auto corners = corners_m(test_board);
    ASSERT_EQ(seen.corners_px.size(), corners.size());
    for (std::size_t k = 0; k < corners.size(); ++k, ++count)
      squares +=
          (seen.corners_px[k] - project(camera, poses()[i] * corners[k]).value()).squaredNorm();
    EXPECT_GT(seen.edge_width_px, 1);
    EXPECT_LT(seen.edge_width_px, 3);
  }
  const double rms_px = std::sqrt(squares / static_cast<double>(count));
  RecordProperty("rms_px", std::to_string(rms_px));
  EXPECT_LT(rms_px, 0.05);
}

TEST(Board, SaysOfWhichSizeTheBoardInSightIs) {
  const auto picture = picture_of(bent_camera(), test_board, poses()[0], 0.7, 2, 1);
  const Board wrong{.columns = 10, .rows = 7, .square_m = 0.02};
  EXPECT_EQ(find_board(picture, wrong).left_out, "shows a board of 9x6 inner corners, not 10x7");
  const Image<std::uint8_t> empty(320, 240, 90);
  EXPECT_EQ(find_board(empty, test_board).left_out, "shows no board of 9x6 inner corners");
}

// Every corner is in sight, but OpenCV's search for 9x6 passes over this one, while its search for
// boards of any size finds 9x6: the reason must not contradict itself.
TEST(Board, SaysThatItIsHardToSeeIfItsSizeIsRight) {
  const auto picture =
      picture_of(bent_camera(), test_board, test::boards_in_light()[0], 0.7, 2, 50);
  EXPECT_EQ(find_board(picture, test_board).left_out,
            "shows the board too obliquely or too dimly to find all of its corners");
}

TEST(Board, LeavesABlurredPictureOutAndSaysByHowMuch) {
  const auto seen =
      find_board(picture_of(bent_camera(), test_board, poses()[0], 4, 2, 1), test_board);
  EXPECT_TRUE(seen.corners_px.empty());
  EXPECT_TRUE(seen.left_out.starts_with("is blurred: edges are ")) << seen.left_out;
  // 10 to 90 % of a normal edge is 2.563 sigma; the sharp edge's own box adds little.
  EXPECT_NEAR(seen.edge_width_px, 2.563 * 4, 2);
}

TEST(Board, RefusesWhatIsNoBoard) {
  EXPECT_THROW(check({.columns = 2, .rows = 6, .square_m = 0.02}), Error);
  EXPECT_THROW(check({.columns = 9, .rows = 6, .square_m = 0}), Error);
  EXPECT_THROW(check({.columns = 9, .rows = 6, .square_m = std::nan("")}), Error);
  EXPECT_TRUE(has_one_orientation(test_board));
  EXPECT_FALSE(has_one_orientation({.columns = 8, .rows = 6, .square_m = 0.02}));
}

}  // namespace
}  // namespace scan
