// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/match_window.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "libscan/acquire/disparity_refinement.h"

namespace scan::decoding {
namespace {

constexpr double same_surface_px = 1;  // disparity step that ends a surface
// How far the matcher leans towards whole columns with all its neighbours: 0.14 px (rms over places
// between columns) on planes that face the pair, none on oblique ones, where it scatters.
constexpr double matcher_lean_px = 0.1;

// Slope of the disparity by least squares over the same surface in a window of twice the reach.
Eigen::Vector2d slope_at(const Image<float>& disparity, int column, int row, int reach) {
  Eigen::Matrix2d moments = Eigen::Matrix2d::Identity() * 1e-3;  // no neighbours: no slope
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  const double centre = disparity(column, row);
  for (int y = std::max(0, row - reach); y <= std::min(disparity.height - 1, row + reach); ++y)
    for (int x = std::max(0, column - reach); x <= std::min(disparity.width - 1, column + reach);
         ++x) {
      const double step = disparity(x, y) - centre;
      const double distance = std::hypot(x - column, y - row);
      if (!(std::abs(step) <= same_surface_px * std::max(1.0, 0.5 * distance))) continue;
      const Eigen::Vector2d offset(x - column, y - row);
      moments += offset * offset.transpose();
      right += step * offset;
    }
  return moments.ldlt().solve(right);
}

// By how far disparities of the same surface scatter about the plane of that slope. Their errors
// are as those of means over the matcher's blocks, so that the plane's three numbers are told by
// count / block^2 independent ones.
MatcherErrors errors_at(const Image<float>& disparity, int column, int row, int block_px,
                        const Eigen::Vector2d& slope) {
  const int reach = refinement_window_px(block_px) - 1;
  double count = 0, sum = 0, sum2 = 0, distances2 = 0;
  const double centre = disparity(column, row);
  for (int y = std::max(0, row - reach); y <= std::min(disparity.height - 1, row + reach); ++y)
    for (int x = std::max(0, column - reach); x <= std::min(disparity.width - 1, column + reach);
         ++x) {
      const Eigen::Vector2d offset(x - column, y - row);
      const double off = disparity(x, y) - centre - slope.dot(offset);
      if (!(std::abs(off) <= same_surface_px)) continue;
      ++count;
      sum += off;
      sum2 += off * off;
      distances2 += offset.squaredNorm();
    }
  const double block2 = 1.0 * block_px * block_px, independent = count / block2;
  const double scatter2 = std::max(0.0, sum2 / count - sum * sum / (count * count)) * independent /
                          std::max(independent - 3, 1.0);
  return {scatter2 + matcher_lean_px * matcher_lean_px,
          scatter2 * block2 / std::max(distances2 / 2, block2)};
}

}  // namespace

Window window_at(const Image<float>& disparity, int column, int row, int block_px) {
  const int half = refinement_window_px(block_px) / 2;
  const Eigen::Vector2d slope = slope_at(disparity, column, row, 2 * half);
  Window window{{}, slope.x(), errors_at(disparity, column, row, block_px, slope)};
  for (int y = std::max(0, row - half); y <= std::min(disparity.height - 1, row + half); ++y)
    for (int x = std::max(0, column - half); x <= std::min(disparity.width - 1, column + half);
         ++x) {
      const double offset = slope.dot(Eigen::Vector2d(x - column, y - row));
      const double step = disparity(x, y) - disparity(column, row);
      if (std::abs(step - offset) <= same_surface_px)
        window.pixels.push_back({x, y, x - column, y - row, offset});
    }
  return window;
}

}  // namespace scan::decoding
