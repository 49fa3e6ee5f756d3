// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/leaf_blocks.h"

#include <limits>

namespace scan {

void LeafBlocks::resize(std::size_t blocks) {
  coordinates_.resize(blocks);
  exact_.resize(blocks * width);
}

void LeafBlocks::fill(std::size_t block, std::span<const LocalPoint> points,
                      std::span<const Eigen::Vector3d> points_m) {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < width; ++i) {
    const bool used = i < points.size();
    coordinates_[block].x[i] = used ? points[i].at[0] : none;
    coordinates_[block].y[i] = used ? points[i].at[1] : none;
    coordinates_[block].z[i] = used ? points[i].at[2] : none;
    if (used) exact_[block * width + i] = {points_m[points[i].index], points[i].index};
  }
}

void LeafBlocks::append(std::span<const LocalPoint> points,
                        std::span<const Eigen::Vector3d> points_m) {
  const std::size_t first = size();
  resize(first + (points.size() + width - 1) / width);
  for (std::size_t block = first; block < size(); ++block)
    fill(block,
         points.subspan((block - first) * width)
             .first(std::min<std::size_t>(width, points.size() - (block - first) * width)),
         points_m);
}

}  // namespace scan
