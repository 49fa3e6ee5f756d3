// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A two-dimensional array of pixels.
#pragma once

#include <cstddef>
#include <vector>

namespace scan {

// Row by row from the top left; pixel (column, row) has its centre at (column, row) px.
template <class T>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<T> pixels;

  Image() = default;
  Image(int width_px, int height_px, T value = {})
      : width(width_px),
        height(height_px),
        pixels(static_cast<std::size_t>(width_px) * height_px, value) {}
  bool empty() const { return pixels.empty(); }
  T& operator()(int column, int row) { return pixels[index(column, row)]; }
  const T& operator()(int column, int row) const { return pixels[index(column, row)]; }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * width + column;
  }
};

}  // namespace scan
