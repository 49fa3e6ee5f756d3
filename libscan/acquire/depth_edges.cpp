// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/depth_edges.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"

namespace scan::decoding {
namespace {

constexpr int hole_px = 5;              // side of the smallest square that makes a hole
constexpr double jump_px = 1;           // between neighbours, beyond the slope
constexpr double steepest_slope = 0.5;  // disparity per column or row of a surface that matches

using Mask = Image<char>;

// The value `any` over a centred window of 2 radius + 1 pixels a side: 1 where a pixel of the
// window (inside the image) has `value`, else 0.
Mask any_within(const Mask& mask, int radius, char value) {
  const auto pass = [&](const Mask& from, int along_column, int along_row) {
    Mask to(from.width, from.height);
    parallel_for(
        static_cast<std::size_t>(from.height),
        [&](std::size_t r) {
          for (int column = 0; column < from.width; ++column) {
            const int row = static_cast<int>(r);
            char found = 0;
            for (int k = -radius; k <= radius && !found; ++k) {
              const int x = column + k * along_column, y = row + k * along_row;
              found = x >= 0 && y >= 0 && x < from.width && y < from.height && from(x, y);
            }
            to(column, row) = found;
          }
        },
        16);
    return to;
  };
  Mask wanted(mask.width, mask.height);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) wanted.pixels[i] = mask.pixels[i] == value;
  return pass(pass(wanted, 1, 0), 0, 1);
}

// Pixels of holes: unmatched ones that some 5 x 5 square of unmatched ones covers (an opening).
Mask holes(const Image<float>& disparity) {
  Mask unmatched(disparity.width, disparity.height);
  for (std::size_t i = 0; i < unmatched.pixels.size(); ++i)
    unmatched.pixels[i] = std::isnan(disparity.pixels[i]);
  Mask centres = any_within(unmatched, hole_px / 2, 0);
  for (char& centre : centres.pixels) centre = !centre;
  return any_within(centres, hole_px / 2, 1);
}

// Both pixels of each pair of matched neighbours, up to two pixels apart, that a surface does not
// join.
void mark_jumps(const Image<float>& disparity, Mask& edges) {
  for (int row = 0; row < disparity.height; ++row)
    for (int column = 0; column < disparity.width; ++column)
      for (const auto& [dx, dy] :
           {std::pair(1, 0), std::pair(2, 0), std::pair(0, 1), std::pair(0, 2)}) {
        if (column + dx >= disparity.width || row + dy >= disparity.height) continue;
        const double difference = disparity(column + dx, row + dy) - disparity(column, row);
        if (!(std::abs(difference) > jump_px + steepest_slope * (dx + dy))) continue;
        edges(column, row) = edges(column + dx, row + dy) = 1;
      }
}

}  // namespace

std::vector<char> near_depth_edge(const Image<float>& disparity, int margin_px) {
  Mask edges = holes(disparity);
  mark_jumps(disparity, edges);
  Mask near = any_within(edges, margin_px, 1);
  for (std::size_t i = 0; i < near.pixels.size(); ++i)
    near.pixels[i] = near.pixels[i] && !std::isnan(disparity.pixels[i]);
  return std::move(near.pixels);
}

}  // namespace scan::decoding
