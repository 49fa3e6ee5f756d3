// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where pixels and the rays inside a pixel stand.
#pragma once

#include <Eigen/Core>
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

}  // namespace scan::synth
