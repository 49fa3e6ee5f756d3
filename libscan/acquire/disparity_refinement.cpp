// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/disparity_refinement.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "libscan/acquire/window_bias.h"
#include "libscan/acquire/window_fit.h"
#include "libscan/core/parallel.h"

namespace scan::decoding {
namespace {

constexpr double same_surface_px = 1;  // disparity step that ends a surface
constexpr double farthest_move_px = 1;

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

std::vector<WindowPixel> window_at(const Image<float>& disparity, int column, int row, int half) {
  const Eigen::Vector2d slope = slope_at(disparity, column, row, 2 * half);
  std::vector<WindowPixel> window;
  for (int y = std::max(0, row - half); y <= std::min(disparity.height - 1, row + half); ++y)
    for (int x = std::max(0, column - half); x <= std::min(disparity.width - 1, column + half);
         ++x) {
      const double offset = slope.dot(Eigen::Vector2d(x - column, y - row));
      const double step = disparity(x, y) - disparity(column, row);
      if (std::abs(step - offset) <= same_surface_px) window.push_back({x, y, offset});
    }
  return window;
}

struct Refined {
  double disparity_px;
  double sigma_px;
};

// Newton steps on weight * residual / noise + (d - start)^2 * prior with the weight that makes the
// curvature of the first the information; returns d, `fit` is the one there.
double descend(const Smoothed& images, const std::vector<WindowPixel>& window, double start,
               double d, double prior, Fit& fit) {
  const double weight =
      fit.texture > 0 ? information(fit, correlated_at(images, window, d)) * fit.noise / fit.texture
                      : 0;
  const auto cost = [&](const Fit& at, double x) {
    return weight * at.residual / at.noise + prior * (x - start) * (x - start);
  };
  for (int iteration = 0; iteration < 8; ++iteration) {
    const double gradient =
        (fit.gradient - fit.residual * fit.noise_slope / (2 * fit.noise)) / fit.noise;
    const double trial =
        d - (gradient * weight + prior * (d - start)) / (fit.slopes2 / fit.noise * weight + prior);
    if (!(std::abs(trial - start) <= farthest_move_px)) break;
    const Fit next = fit_at(images, window, trial);
    if (next.count < fit.count || !(cost(next, trial) < cost(fit, d))) break;
    const double move = std::abs(trial - d);
    d = trial;
    fit = next;
    if (move < 1e-4) break;
  }
  return d;
}

Refined refine_pixel(const Smoothed& images, const std::vector<WindowPixel>& window, double start,
                     double match_sigma_px) {
  const double prior = 1 / (match_sigma_px * match_sigma_px);
  Fit fit = fit_at(images, window, start);
  if (fit.count < 6) return {start, match_sigma_px};
  // Twice: the first residual holds the error of the start besides the noise.
  double d = descend(images, window, start, start, prior, fit);
  d = descend(images, window, start, d, prior, fit);
  return {d, 1 / std::sqrt(information(fit, correlated_at(images, window, d)) + prior)};
}

// The noise of the places that tell the curvature is little beside what the pixel's own gains.
void take_away_window_bias(RefinedDisparity& refined, int half) {
  const Image<float> with_bias = refined.disparity_px;
  parallel_for(with_bias.pixels.size(), [&](std::size_t i) {
    if (std::isnan(with_bias.pixels[i])) return;
    const int column = static_cast<int>(i % with_bias.width),
              row = static_cast<int>(i / with_bias.width);
    const WindowShift shift = window_shift(with_bias, column, row, half);
    refined.disparity_px.pixels[i] -= static_cast<float>(shift.shift_px);
    refined.sigma_px.pixels[i] *= static_cast<float>(1 + shift.own_share);
  });
}

}  // namespace

RefinedDisparity refine(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                        const Image<float>& disparity_px, int block_px, double match_sigma_px) {
  // The matcher's steps make slopes wrong by some hundredths, and uneven texture makes errors of
  // them: windows take their slopes from disparities once refined.
  constexpr int passes = 2;
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  RefinedDisparity result{disparity_px, Image<float>(left.width, left.height, unknown),
                          Image<float>(left.width, left.height, unknown)};
  const int half = refinement_window_px(block_px) / 2;
  const Image<float> left_grey = in_floats(left), right_grey = in_floats(right);
  const Smoothed images = smoothed(left_grey, right_grey);
  for (int pass = 0; pass < passes; ++pass) {
    const Image<float> shape = result.disparity_px;
    parallel_for(disparity_px.pixels.size(), [&](std::size_t i) {
      const double start = disparity_px.pixels[i];
      if (std::isnan(start)) return;
      const int column = static_cast<int>(i % left.width), row = static_cast<int>(i / left.width);
      const std::vector<WindowPixel> window = window_at(shape, column, row, half);
      const Refined refined = refine_pixel(images, window, start, match_sigma_px);
      result.disparity_px.pixels[i] = static_cast<float>(refined.disparity_px);
      result.sigma_px.pixels[i] = static_cast<float>(refined.sigma_px);
      result.correlation.pixels[i] =
          static_cast<float>(correlation_at(left_grey, right_grey, window, refined.disparity_px));
    });
  }
  take_away_window_bias(result, half);
  return result;
}

}  // namespace scan::decoding
