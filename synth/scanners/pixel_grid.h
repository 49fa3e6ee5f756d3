// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where pixels and the rays inside a pixel stand, and in which order they are best traced.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

namespace scan::synth {

// Of the pixel with an index counted row by row.
struct PixelPlace {
  int column;
  int row;
};
inline PixelPlace place_of(std::size_t pixel, int width_px) {
  const auto width = static_cast<std::size_t>(width_px);
  return {static_cast<int>(pixel % width), static_cast<int>(pixel / width)};
}

inline std::size_t index_of(const PixelPlace& place, int width_px) {
  return static_cast<std::size_t>(place.row) * static_cast<std::size_t>(width_px) +
         static_cast<std::size_t>(place.column);
}

// Ray i of per_side^2 that sample a pixel's area: the centres of its equal squares, row by row.
inline Eigen::Vector2d sub_pixel(const PixelPlace& pixel, int i, int per_side) {
  const int across = i % per_side, down = i / per_side;
  return {pixel.column + (across + 0.5) / per_side - 0.5,
          pixel.row + (down + 0.5) / per_side - 0.5};
}

// The pixels of an image in squares of 4 x 4, one strip of them after the other: rays that travel
// together see neighbours. From the i-th on.
class TileWalk {
 public:
  TileWalk(std::size_t i, int width_px, int height_px) : width_(width_px), height_(height_px) {
    const auto width = static_cast<std::size_t>(width_);
    const std::size_t strip = i / (side * width), in_strip = i - strip * side * width;
    top_ = static_cast<int>(strip) * side;
    const auto rows = static_cast<std::size_t>(std::min(side, height_ - top_));
    const std::size_t tile = rows > 0 ? in_strip / (side * rows) : 0;
    left_ = static_cast<int>(tile) * side;
    const int columns = std::min(side, width_ - left_);
    const auto in_tile = static_cast<int>(in_strip - tile * side * rows);
    down_ = in_tile / columns;
    across_ = in_tile % columns;
  }
  PixelPlace place() const { return {left_ + across_, top_ + down_}; }
  void next() {
    if (++across_ < std::min(side, width_ - left_)) return;
    across_ = 0;
    if (++down_ < std::min(side, height_ - top_)) return;
    down_ = 0;
    if ((left_ += side) < width_) return;
    left_ = 0;
    top_ += side;
  }

 private:
  static constexpr int side = 4;
  int width_, height_;
  int top_, left_;  // of the square
  int down_, across_;
};

}  // namespace scan::synth
