// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line_speckle.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "libscan/core/random.h"

namespace scan::synth {
namespace {

using std::numbers::pi;
constexpr double finest_px = 0.25;                          // grain that is simulated
constexpr std::uint64_t own_streams = 0x4c4b4b4345505300u;  // apart from the detector's

// Gamma variate of mean 1 and shape >= 1 (Marsaglia and Tsang 2000).
double gamma_of_mean_1(double shape, RandomStream& random) {
  const double d = shape - 1.0 / 3, c = 1 / std::sqrt(9 * d);
  while (true) {
    const double x = random.normal();
    const double v = std::pow(1 + c * x, 3);
    const double u = random.uniform();
    if (v > 0 && std::log(1 - u) < x * x / 2 + d - d * v + d * std::log(v)) return d * v / shape;
  }
}

// One axis of the sub-pixel grid with the kernel that turns white noise into the field. The field
// correlates like exp(-x^2 / (4 s^2)) for a kernel exp(-x^2 / (2 s^2)), so s = sqrt(2) grain / pi.
struct Axis {
  int per_px = 1;
  std::vector<double> kernel;  // odd; sum of squares 1

  explicit Axis(double grain_px) {
    const double sigma_px = std::numbers::sqrt2 * grain_px / pi;
    // the pixel's mean is then within 1 % of the integral
    per_px = std::max(3, static_cast<int>(std::ceil(1.5 / sigma_px)));
    const double sigma = sigma_px * per_px;
    double squares = 0;
    for (int j = -reach(sigma); j <= reach(sigma); ++j) {
      kernel.push_back(std::exp(-j * j / (2 * sigma * sigma)));
      squares += kernel.back() * kernel.back();
    }
    for (double& k : kernel) k /= std::sqrt(squares);
  }
  static int reach(double sigma) { return static_cast<int>(std::ceil(3.5 * sigma)); }
  int half() const { return static_cast<int>(kernel.size() / 2); }
};

using Field = std::vector<std::complex<double>>;

// White noise of mean square 1 at columns [first, first + count) of a line of the grid.
Field white(const RenderAddress& address, std::uint64_t line, std::int64_t first, int count) {
  const std::uint64_t key = address.seed ^ own_streams;
  Field noise;
  for (int i = 0; i < count; ++i) {
    const auto bits =
        philox4x32({static_cast<std::uint32_t>(first + i), address.scan,
                    static_cast<std::uint32_t>(line), static_cast<std::uint32_t>(line >> 32)},
                   {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)});
    const double u = (bits[0] + 0.5) * 0x1p-32, angle = 2 * pi * bits[1] * 0x1p-32;
    noise.push_back(std::polar(std::sqrt(-std::log(u)), angle));
  }
  return noise;
}

// Adds `weight` times one pattern's mean intensity over each pixel of a row.
void add_pattern(const Axis& across, const Axis& down, const RenderAddress& address,
                 std::uint64_t first_line, int first, double weight, std::span<double> mean) {
  const int columns = static_cast<int>(mean.size()) * across.per_px;
  const int lines = down.per_px + 2 * down.half();
  std::vector<Field> smooth(lines, Field(columns));
  for (int line = 0; line < lines; ++line) {
    const Field noise =
        white(address, first_line + line, std::int64_t{first} * across.per_px - across.half(),
              columns + 2 * across.half());
    for (int x = 0; x < columns; ++x)
      for (std::size_t j = 0; j < across.kernel.size(); ++j)
        smooth[line][x] += across.kernel[j] * noise[x + j];
  }
  const double share = weight / (across.per_px * down.per_px);
  for (int y = 0; y < down.per_px; ++y)
    for (int x = 0; x < columns; ++x) {
      std::complex<double> field = 0;
      for (std::size_t j = 0; j < down.kernel.size(); ++j)
        field += down.kernel[j] * smooth[y + j][x];
      mean[x / across.per_px] += share * std::norm(field);
    }
}

// The fewest weights with sum 1 and sum of squares contrast^2: all equal but the last.
std::vector<double> pattern_weights(double contrast) {
  const int n = static_cast<int>(std::ceil(1 / (contrast * contrast) - 1e-9));
  if (n == 1) return {1};
  const double m = n - 1;
  const double root = std::sqrt(std::max(0.0, 1 - n * (1 - contrast * contrast) / m));
  std::vector<double> weights(n, (1 + root) / n);
  weights.back() = 1 - m * weights.front();
  return weights;
}

void mottle_coarse(const Speckle& speckle, const RenderAddress& address, int step, int row,
                   int first, std::span<double> row_e) {
  const Axis across(speckle.grain_px.x()), down(speckle.grain_px.y());
  const std::vector<double> weights = pattern_weights(speckle.contrast);
  std::vector<double> mean(row_e.size(), 0);
  for (std::size_t pattern = 0; pattern < weights.size(); ++pattern) {
    // 2^32 lines for each step and pattern; rows of a step share the lines at their border
    const std::uint64_t place = static_cast<std::uint64_t>(step) * weights.size() + pattern;
    const std::uint64_t first_line = (place << 32) + static_cast<std::uint64_t>(row) * down.per_px;
    add_pattern(across, down, address, first_line, first, weights[pattern], mean);
  }
  for (std::size_t i = 0; i < row_e.size(); ++i) row_e[i] *= mean[i];
}

}  // namespace

Speckle speckle_of(const LaserLine& s) {
  if (s.speckle_contrast == 0) return {};
  return {
      .contrast = s.speckle_contrast,
      .grain_px = s.wavelength_m / s.aperture_m * Eigen::Vector2d(s.camera.fx_px, s.camera.fy_px)};
}

// Integral of (1 - |x|) exp(-x^2 / a^2) over -1..1.
double pixel_share(double grain_px) {
  const double a = 2 * grain_px / pi;
  return std::sqrt(pi) * a * std::erf(1 / a) + a * a * std::expm1(-1 / (a * a));
}

void mottle(const Speckle& speckle, const RenderAddress& address, int step, int row, int first,
            std::span<double> row_e) {
  if (speckle.grain_px.minCoeff() >= finest_px)
    return mottle_coarse(speckle, address, step, row, first, row_e);
  const double variance = speckle.contrast * speckle.contrast * pixel_share(speckle.grain_px.x()) *
                          pixel_share(speckle.grain_px.y());
  const std::uint64_t ray = (static_cast<std::uint64_t>(step) << 32) + row;
  RandomStream random(address.seed ^ own_streams, address.scan, ray);
  for (double& e : row_e) e *= gamma_of_mean_1(1 / variance, random);
}

}  // namespace scan::synth
