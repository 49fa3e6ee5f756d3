// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/window_bias.h"

#include <cmath>
#include <numbers>
#include <optional>

namespace scan::decoding {
namespace {

// The windows there do not overlap the pixel's own, and with c = half (half + 1) / (6 reach^2)
// taking the shift away makes the noise 1 + 4 c times as large: 1.06 for windows of 7.
constexpr int reach_in_halves = 4;
constexpr double steepest_px = 0.5;  // per pixel

// Of the second differences' sum.
double share_of(int half) {
  const int reach = reach_in_halves * half;
  return half * (half + 1) / (6.0 * reach * reach);
}

// Disparity at a place of the same surface less that at its middle; none off the image or surface.
std::optional<double> step_to(const Image<float>& disparity_px, int column, int row, int dx,
                              int dy) {
  const int x = column + dx, y = row + dy;
  if (x < 0 || x >= disparity_px.width || y < 0 || y >= disparity_px.height) return std::nullopt;
  const double step = disparity_px(x, y) - disparity_px(column, row);
  if (!(std::abs(step) <= steepest_px * (std::abs(dx) + std::abs(dy)))) return std::nullopt;
  return step;
}

}  // namespace

WindowShift window_shift(const Image<float>& disparity_px, int column, int row, int half) {
  const int reach = reach_in_halves * half;
  const double share = share_of(half);
  WindowShift result;
  for (const auto& [dx, dy] : {std::pair(reach, 0), std::pair(0, reach)}) {
    const auto before = step_to(disparity_px, column, row, -dx, -dy);
    const auto after = step_to(disparity_px, column, row, dx, dy);
    if (!before || !after) continue;
    result.shift_px += share * (*before + *after);
    result.own_share += 2 * share;
  }
  return result;
}

double window_transfer(double period_px, int half) {
  const double wave = 2 * std::numbers::pi / period_px;  // rad per pixel
  double mean = 1;
  for (int x = 1; x <= half; ++x) mean += 2 * std::cos(wave * x);
  const double raised = 1 + 2 * share_of(half) * (1 - std::cos(wave * reach_in_halves * half));
  return mean / (2 * half + 1) * raised;
}

}  // namespace scan::decoding
