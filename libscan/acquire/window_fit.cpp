// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/window_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libscan/core/parallel.h"

namespace scan::decoding {
namespace {

// Value and derivative at a place within a row; none outside [1, width - 2].
struct Sample {
  double value = 0;
  double slope = 0;
  double fraction = 0;  // of the way to the next column
};

bool sample(const Image<float>& image, double x, int row, Sample& result) {
  if (!(x >= 1 && x < image.width - 2)) return false;
  const int i = static_cast<int>(x);
  const double t = result.fraction = x - i;
  const double a = image(i - 1, row), b = image(i, row), c = image(i + 1, row),
               d = image(i + 2, row);
  const double p1 = c - a, p2 = 2 * a - 5 * b + 4 * c - d, p3 = 3 * (b - c) + d - a;
  result.value = b + 0.5 * t * (p1 + t * (p2 + t * p3));
  result.slope = 0.5 * (p1 + t * (2 * p2 + t * 3 * p3));
  return true;
}

Image<float> smoothed(const Image<float>& image) {
  Image<float> result(image.width, image.height);
  parallel_for(static_cast<std::size_t>(image.height), [&](std::size_t index) {
    const int row = static_cast<int>(index);
    for (int x = 0; x < image.width; ++x)
      result(x, row) = (image(std::max(x - 1, 0), row) + 2 * image(x, row) +
                        image(std::min(x + 1, image.width - 1), row)) /
                       4;
  });
  return result;
}

// Along the rows; to fourth order, so that waves of 7 px lose 2 % and not 13 %.
Image<float> slopes_of(const Image<float>& image) {
  Image<float> result(image.width, image.height);
  parallel_for(static_cast<std::size_t>(image.height), [&](std::size_t index) {
    const int row = static_cast<int>(index);
    const auto at = [&](int x) { return image(std::clamp(x, 0, image.width - 1), row); };
    for (int x = 0; x < image.width; ++x)
      result(x, row) = (8 * (at(x + 1) - at(x - 1)) - (at(x + 2) - at(x - 2))) / 12;
  });
  return result;
}

// Variance of a pixel. The residuals have the covariance s^2 2 C, C as above, of trace n `noise`,
// so their sum of squares, less the mean's and the disparity's own, is s^2 (n noise - 2 1^T C 1 / n
// - 2 g^T C g / g^T g), g the scene's slopes. That is worth 0.52 n degrees of freedom (trace^2 over
// the square's trace for windows of 7 x 7), and of an error over a standard deviation told by k of
// them the variance is k / (k - 2) (JCGM 101:2008, 6.4.9.4).
double pixel_variance(const Fit& fit, const Correlated& noise) {
  constexpr double rounding_variance = 1.0 / 12;
  const double squares = fit.noise * fit.count - 2 * noise.ones / fit.count -
                         2 * std::min(noise.texture / fit.texture, 1.0);
  const double freedom = 0.52 * fit.count;
  return std::max(fit.residual / squares * freedom / (freedom - 2), rounding_variance);
}

}  // namespace

Image<float> in_floats(const Image<std::uint8_t>& image) {
  Image<float> result(image.width, image.height);
  std::copy(image.pixels.begin(), image.pixels.end(), result.pixels.begin());
  return result;
}

Smoothed smoothed(const Image<float>& left, const Image<float>& right) {
  Smoothed images{smoothed(left), smoothed(right), {}};
  images.left_slopes = slopes_of(images.left);
  return images;
}

Fit fit_at(const Smoothed& images, const std::vector<WindowPixel>& window, double d) {
  Fit fit;
  double e = 0, e2 = 0, g = 0, g2 = 0, eg = 0, h = 0, gh = 0;
  for (const WindowPixel& pixel : window) {
    Sample seen;
    if (!sample(images.right, pixel.column - d - pixel.offset_px, pixel.row, seen)) continue;
    const double error = images.left(pixel.column, pixel.row) - seen.value;
    const double left_slope = images.left_slopes(pixel.column, pixel.row);
    // What (1, 2, 1) / 4 and cubic convolution leave of a pixel's variance: the sum of the squares
    // of all weights is 3 / 8 - (9 u^2 + 6 u^3) / 32, u = t (1 - t).
    const double u = seen.fraction * (1 - seen.fraction);
    ++fit.count;
    fit.noise += (24 - u * u * (9 + 6 * u)) / 32;
    fit.noise_slope += u * (1 + u) * (1 - 2 * seen.fraction) * 18 / 32;
    e += error;
    e2 += error * error;
    g += seen.slope;
    g2 += seen.slope * seen.slope;
    eg += error * seen.slope;
    h += left_slope;
    gh += left_slope * seen.slope;
  }
  if (fit.count == 0) return fit;
  fit.noise /= fit.count;
  fit.noise_slope /= fit.count;
  fit.residual = std::max(0.0, e2 - e * e / fit.count);
  fit.slopes2 = std::max(0.0, g2 - g * g / fit.count);
  fit.texture = std::max(0.0, gh - g * h / fit.count);
  fit.gradient = eg - e * g / fit.count;
  return fit;
}

double correlation_at(const Image<float>& left, const Image<float>& right,
                      const std::vector<WindowPixel>& window, double d) {
  double count = 0, l = 0, l2 = 0, r = 0, r2 = 0, lr = 0;
  for (const WindowPixel& pixel : window) {
    Sample seen;
    if (!sample(right, pixel.column - d - pixel.offset_px, pixel.row, seen)) continue;
    const double grey = left(pixel.column, pixel.row);
    ++count;
    l += grey;
    l2 += grey * grey;
    r += seen.value;
    r2 += seen.value * seen.value;
    lr += grey * seen.value;
  }
  if (count == 0) return 0;
  const double left2 = l2 - l * l / count, right2 = r2 - r * r / count;
  return left2 > 0 && right2 > 0 ? (lr - l * r / count) / std::sqrt(left2 * right2) : 0;
}

Correlated correlated_at(const Smoothed& images, const std::vector<WindowPixel>& window, double d) {
  struct Slopes {
    int column, row;
    double left, right;
  };
  std::vector<Slopes> slopes;
  slopes.reserve(window.size());
  double left = 0, right = 0;
  for (const WindowPixel& pixel : window) {
    Sample seen;
    if (!sample(images.right, pixel.column - d - pixel.offset_px, pixel.row, seen)) continue;
    const double left_slope = images.left_slopes(pixel.column, pixel.row);
    slopes.push_back({pixel.column, pixel.row, left_slope, seen.slope});
    left += left_slope;
    right += seen.slope;
  }
  const auto count = static_cast<double>(slopes.size());
  constexpr std::array correlation = {6.0 / 16, 4.0 / 16, 1.0 / 16};
  Correlated sum;
  for (std::size_t i = 0; i < slopes.size(); ++i)
    for (std::size_t j = i; j < slopes.size() && j <= i + 2; ++j) {
      const int apart = slopes[j].column - slopes[i].column;
      if (slopes[j].row != slopes[i].row || apart > 2) break;
      const double share = correlation[static_cast<std::size_t>(apart)] * (apart == 0 ? 0.5 : 1);
      sum.ones += 2 * share;
      sum.texture += share * ((slopes[i].left - left / count) * (slopes[j].right - right / count) +
                              (slopes[j].left - left / count) * (slopes[i].right - right / count));
    }
  return sum;
}

// The residuals times g have the variance 2 s^2
// g^T C g. The noise in the right image's slopes, noise2 = slopes2 - T, T = g^T g, adds, times the
// left image's noise, its share: by the correlations of both 0.51 s^2 noise2 on a column, 0.40
// between two. Times the right image's own noise it adds up to nothing, being half the slope of its
// square. All over the squared curvature T^2 of the residual.
double information(const Fit& fit, const Correlated& noise) {
  constexpr double coloured = 0.44;
  if (!(fit.texture > 0) || !(noise.texture > 0)) return 0;
  const double noise2 = std::max(0.0, fit.slopes2 - fit.texture);
  return fit.texture * fit.texture /
         (pixel_variance(fit, noise) * (2 * noise.texture + coloured * noise2));
}

}  // namespace scan::decoding
