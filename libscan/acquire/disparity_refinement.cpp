// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/disparity_refinement.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "libscan/acquire/match_window.h"
#include "libscan/acquire/window_bias.h"
#include "libscan/core/parallel.h"

namespace scan::decoding {
namespace {

constexpr double farthest_move_px = 1;

// Value and derivative at a place within a row; none outside [1, width - 2].
struct Sample {
  double value = 0;
  double slope = 0;
};

bool is_inside(const Image<std::uint8_t>& image, double x) {
  return x >= 1 && x < image.width - 2;
}

bool sample(const Image<std::uint8_t>& image, double x, int row, Sample& result) {
  if (!is_inside(image, x)) return false;
  const int i = static_cast<int>(x);
  const double t = x - i;
  const double a = image(i - 1, row), b = image(i, row), c = image(i + 1, row),
               d = image(i + 2, row);
  const double p1 = c - a, p2 = 2 * a - 5 * b + 4 * c - d, p3 = 3 * (b - c) + d - a;
  result.value = b + 0.5 * t * (p1 + t * (p2 + t * p3));
  result.slope = 0.5 * (p1 + t * (2 * p2 + t * 3 * p3));
  return true;
}

double slope_of(const Image<std::uint8_t>& image, int column, int row) {
  const int before = std::max(0, column - 1), after = std::min(image.width - 1, column + 1);
  return 0.5 * (image(after, row) - image(before, row));
}

// Sums over the window at disparity d, brightness difference eliminated.
struct Fit {
  int count = 0;
  double residual = 0;     // sum of squares
  double slopes2 = 0;      // sum of squared slopes of the right image
  double texture = 0;      // sum of left slope times right slope: free of the noise in the slopes
  double gradient = 0;     // sum of residual times slope
  double correlation = 0;  // of the two windows, -1 to 1
};

Fit fit_at(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
           const std::vector<WindowPixel>& window, double d) {
  Fit fit;
  double e = 0, e2 = 0, g = 0, g2 = 0, eg = 0, h = 0, gh = 0;
  double l = 0, l2 = 0, r = 0, r2 = 0;
  for (const WindowPixel& pixel : window) {
    Sample seen;
    if (!sample(right, pixel.column - d - pixel.offset_px, pixel.row, seen)) continue;
    const double grey = left(pixel.column, pixel.row);
    const double error = grey - seen.value;
    l += grey;
    l2 += grey * grey;
    r += seen.value;
    r2 += seen.value * seen.value;
    const double left_slope = slope_of(left, pixel.column, pixel.row);
    ++fit.count;
    e += error;
    e2 += error * error;
    g += seen.slope;
    g2 += seen.slope * seen.slope;
    eg += error * seen.slope;
    h += left_slope;
    gh += left_slope * seen.slope;
  }
  if (fit.count == 0) return fit;
  fit.residual = std::max(0.0, e2 - e * e / fit.count);
  fit.slopes2 = std::max(0.0, g2 - g * g / fit.count);
  fit.texture = std::max(0.0, gh - g * h / fit.count);
  fit.gradient = eg - e * g / fit.count;
  const double left2 = l2 - l * l / fit.count, right2 = r2 - r * r / fit.count;
  if (left2 > 0 && right2 > 0)
    fit.correlation = (left2 + right2 - fit.residual) / (2 * std::sqrt(left2 * right2));
  return fit;
}

struct Refined {
  double disparity_px;
  double sigma_px;
  double correlation;
};

// Variance of a difference between the images where the windows match, never below their rounding.
double residual_variance(const Fit& fit) {
  constexpr double rounding_variance = 1.0 / 6;  // two images, 1/12 each
  return std::max(fit.residual / (fit.count - 2), rounding_variance);
}

// What the window weighs against the start. Noise in the slopes adds to slopes2 but not to the
// texture T: with the variance s^2 of the residuals T^2 / (slopes2 s^2).
double information(const Fit& fit) {
  return fit.slopes2 > 0 ? fit.texture * fit.texture / (fit.slopes2 * residual_variance(fit)) : 0;
}

// Newton steps on residual * information / slopes2 + (d - start)^2 * prior; returns d, `fit` is the
// one there.
double descend(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
               const std::vector<WindowPixel>& window, double start, double d, double prior,
               Fit& fit) {
  const double weight = fit.slopes2 > 0 ? information(fit) / fit.slopes2 : 0;
  const auto cost = [&](const Fit& at, double x) {
    return at.residual * weight + prior * (x - start) * (x - start);
  };
  for (int iteration = 0; iteration < 8; ++iteration) {
    const double trial =
        d - (fit.gradient * weight + prior * (d - start)) / (fit.slopes2 * weight + prior);
    if (!(std::abs(trial - start) <= farthest_move_px)) break;
    const Fit next = fit_at(left, right, window, trial);
    if (next.count < fit.count || !(cost(next, trial) < cost(fit, d))) break;
    const double move = std::abs(trial - d);
    d = trial;
    fit = next;
    if (move < 1e-4) break;
  }
  return d;
}

// Sums over the window at the place found, for its sigma.
struct Yield {
  // What cubic convolution leaves of the right image's noise, the sum of the squares of its four
  // weights, from 1 on a column to 0.64 halfway to the next; and its derivative along the row.
  double noise = 0, noise_slope = 0;
  Eigen::Vector2d lever = Eigen::Vector2d::Zero();  // texture times the distance from the centre
};

Yield yield_at(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
               const std::vector<WindowPixel>& window, double d) {
  Yield sum;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  double slopes = 0, count = 0;
  for (const WindowPixel& pixel : window) {
    const double x = pixel.column - d - pixel.offset_px;
    Sample seen;
    if (!sample(right, x, pixel.row, seen)) continue;
    const double t = x - static_cast<int>(x), u = t * (1 - t);
    sum.noise += 1 - u * u * (4.5 + 5 * u);
    sum.noise_slope -= u * (9 + 15 * u) * (1 - 2 * t);
    const Eigen::Vector2d moment =
        slope_of(left, pixel.column, pixel.row) * Eigen::Vector2d(pixel.dx, pixel.dy);
    sum.lever += seen.slope * moment;
    first += moment;
    slopes += seen.slope;
    ++count;
  }
  sum.lever -= slopes / count * first;
  return sum;
}

// The error of what descend() finds is (w F + prior E) / (w T + prior) with its weight w, the
// error E of the start, and F, what is wrong with half the residual's slope at the true place. Of
// a pixel's variance s^2 the left image's noise gives F the variance s^2 slopes2, by slopes that
// are noisy themselves; the right image's gives s^2 T, since interpolation passes the waves that
// slopes are made of. By its own slopes it gives nothing but a mean, s^2 / 2 times the derivative
// of the noise left, which draws matches between columns. A window that follows a wrong slope is
// off by the lever of its texture. T and the lever are by the left image's slopes, which are
// 1 - row_slope times the right one's.
double sigma_of(const Fit& fit, const Yield& yield, const Window& window, double prior) {
  const double weight = fit.slopes2 > 0 ? information(fit) / fit.slopes2 : 0;
  const double shrunk = std::max(1 - window.row_slope, 0.5);
  const double texture = fit.texture / shrunk;
  const double variance = residual_variance(fit) / (1 + yield.noise / fit.count);
  const double drawn = variance * yield.noise_slope / 2;
  const double turned2 = window.matcher.slope * (yield.lever / shrunk).squaredNorm();
  const double of_window = variance * (fit.slopes2 + texture) + drawn * drawn + turned2;
  return std::sqrt(weight * weight * of_window + prior * prior * window.matcher.disparity_px2) /
         (weight * texture + prior);
}

Refined refine_pixel(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                     const Window& window, double start, double match_sigma_px) {
  const double prior = 1 / (match_sigma_px * match_sigma_px);
  Fit fit = fit_at(left, right, window.pixels, start);
  if (fit.count < 6) return {start, match_sigma_px, fit.correlation};
  // Twice: the first residual holds the error of the start besides the noise.
  double d = descend(left, right, window.pixels, start, start, prior, fit);
  d = descend(left, right, window.pixels, start, d, prior, fit);
  return {d, sigma_of(fit, yield_at(left, right, window.pixels, d), window, prior),
          fit.correlation};
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
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  RefinedDisparity result{disparity_px, Image<float>(left.width, left.height, unknown),
                          Image<float>(left.width, left.height, unknown)};
  parallel_for(disparity_px.pixels.size(), [&](std::size_t i) {
    const double start = disparity_px.pixels[i];
    if (std::isnan(start)) return;
    const int column = static_cast<int>(i % left.width), row = static_cast<int>(i / left.width);
    const Refined refined = refine_pixel(
        left, right, window_at(disparity_px, column, row, block_px), start, match_sigma_px);
    result.disparity_px.pixels[i] = static_cast<float>(refined.disparity_px);
    result.sigma_px.pixels[i] = static_cast<float>(refined.sigma_px);
    result.correlation.pixels[i] = static_cast<float>(refined.correlation);
  });
  take_away_window_bias(result, refinement_window_px(block_px) / 2);
  return result;
}

}  // namespace scan::decoding
