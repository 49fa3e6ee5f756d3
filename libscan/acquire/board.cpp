// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/board.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "libscan/core/error.h"
#include "libscan/core/shortest.h"

namespace scan {
namespace {

constexpr int search_flags = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE;

std::string size_text(int columns, int rows) {
  return std::to_string(columns) + "x" + std::to_string(rows);
}

// Moves each corner to where the grey levels' slopes about it all point past it (Foerstner and
// Guelch 1987). The window reaches a quarter of the way to the next corner: OpenCV 4.6's finder
// alone is off by 0.12 px, with windows of 5 px by 0.05, of 8 px by 0.04.
void refine(const cv::Mat& picture, std::vector<cv::Point2f>& corners) {
  double nearest_px = 1e9;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      nearest_px = std::min(nearest_px, cv::norm(corners[i] - corners[k]));
  const int half = std::clamp(static_cast<int>(nearest_px / 4), 2, 12);
  const int rounds = cv::TermCriteria::COUNT | cv::TermCriteria::EPS;
  cv::cornerSubPix(picture, corners, {half, half}, {-1, -1}, {rounds, 100, 1e-4});
}

// Why the board asked for is not there: the picture shows one of another size, or none.
std::string why_missing(const cv::Mat& picture, const Board& board) {
  std::vector<cv::Point2f> corners;
  cv::Mat meta;
  const std::string wanted = size_text(board.columns, board.rows);
  const bool any = cv::findChessboardCornersSB(picture, {3, 3}, corners,
                                               search_flags | cv::CALIB_CB_LARGER, meta);
  if (!any || meta.cols * meta.rows < 9) return "shows no board of " + wanted + " inner corners";
  int columns = std::max(meta.cols, meta.rows), rows = std::min(meta.cols, meta.rows);
  if (board.columns < board.rows) std::swap(columns, rows);
  if (columns == board.columns && rows == board.rows)
    return "shows the board too obliquely or too dimly to find all of its corners";
  return "shows a board of " + size_text(columns, rows) + " inner corners, not " + wanted;
}

double edge_width_px(const cv::Mat& picture, const Board& board,
                     const std::vector<cv::Point2f>& corners) {
  const cv::Size size(board.columns, board.rows);
  const double across = cv::estimateChessboardSharpness(picture, size, corners, 0.8F, false)[0];
  const double along = cv::estimateChessboardSharpness(picture, size, corners, 0.8F, true)[0];
  return std::max(across, along);
}

}  // namespace

void check(const Board& board) {
  constexpr int least = 3, most = 1000;
  for (const auto& [name, count] : {std::pair{"columns", board.columns}, {"rows", board.rows}})
    if (count < least || count > most)
      throw Error(Trouble::usage, std::string("board/") + name + ": is " + std::to_string(count) +
                                      ", must be 3 to 1000 inner corners");
  if (!(board.square_m > 0) || !std::isfinite(board.square_m))
    throw Error(Trouble::usage,
                "board/square_m: is " + shortest(board.square_m) + ", must be positive");
}

std::vector<Eigen::Vector3d> corners_m(const Board& board) {
  std::vector<Eigen::Vector3d> corners;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column)
      corners.emplace_back(column * board.square_m, row * board.square_m, 0);
  return corners;
}

bool has_one_orientation(const Board& board) {
  return (board.columns + board.rows) % 2 == 1;
}

BoardSighting find_board(const Image<std::uint8_t>& picture, const Board& board,
                         const BoardOptions& options) {
  check(board);
  BoardSighting sighting{.width_px = picture.width, .height_px = picture.height};
  // OpenCV takes no pointer to const, and writes nothing to an input.
  const cv::Mat pixels(picture.height, picture.width, CV_8UC1,
                       const_cast<std::uint8_t*>(picture.pixels.data()));
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCornersSB(pixels, {board.columns, board.rows}, corners, search_flags)) {
    sighting.left_out = why_missing(pixels, board);
    return sighting;
  }
  sighting.edge_width_px = edge_width_px(pixels, board, corners);
  if (sighting.edge_width_px > options.max_edge_width_px) {
    sighting.left_out = "is blurred: edges are " + std::to_string(sighting.edge_width_px) +
                        " px wide, must be at most " + std::to_string(options.max_edge_width_px);
    return sighting;
  }
  refine(pixels, corners);
  for (const cv::Point2f& corner : corners) sighting.corners_px.emplace_back(corner.x, corner.y);
  return sighting;
}

}  // namespace scan
