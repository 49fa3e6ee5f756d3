// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The chessboard by which devices are calibrated, and where a picture shows it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "libscan/core/image.h"

namespace scan {

// Counts inner corners, where four squares meet: a board of 10 x 7 squares has 9 x 6. Board frame:
// x along a row of corners, y along a column, z = 0; the first corner is the origin.
struct Board {
  int columns = 0;
  int rows = 0;
  double square_m = 0;  // side of a square
};

// Throws scan::Error (usage) naming the field: 3 to 1000 corners each way, a positive side.
void check(const Board& board);

// All corners row by row, metres, board frame.
std::vector<Eigen::Vector3d> corners_m(const Board& board);

// True if a half turn of the board can be told: one count of corners even, the other odd.
bool has_one_orientation(const Board& board);

struct BoardOptions {
  // A picture whose edges (10 % to 90 % of their rise) are wider has been shaken or is out of
  // focus, and its corners are no longer where the board's are. OpenCV's manual calls 3 px sharp;
  // twice that is a choice.
  double max_edge_width_px = 6;
};

// What one picture says of the board.
struct BoardSighting {
  int width_px = 0;
  int height_px = 0;
  std::vector<Eigen::Vector2d> corners_px;  // in the order of corners_m; empty if left out
  double edge_width_px = 0;                 // mean over the board; 0 if it was not found
  std::string left_out;                     // why the picture cannot be used; empty if it can
};

// Finds the corners by OpenCV's findChessboardCornersSB (Duda and Frese, BMVC 2018) and
// cornerSubPix. A board of
// another size, too little sharpness and no board at all are told apart in `left_out`. Boards
// without one orientation may be found turned by half.
BoardSighting find_board(const Image<std::uint8_t>& picture, const Board& board,
                         const BoardOptions& options = {});

}  // namespace scan
