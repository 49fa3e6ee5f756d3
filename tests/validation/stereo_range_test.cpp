// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>

#include "tests/validation/scanner_range.h"

namespace scan::synth {
namespace {

// What StereoOptions' block of 5 px makes of the refinement: a window of 7 x 7, its slope from
// 13 x 13.
constexpr int half_window_px = 3;
constexpr int half_slope_px = 6;
constexpr int margin_px = 8;  // beside limb and image edges the matcher's own windows are cut
// The match to be refined is wrong by at most so much: sixteenths, and the pull towards whole
// pixels of a parabola through matching costs, which stays below a quarter (Szeliski and Scharstein
// 2004).
constexpr double match_error_px = 0.25;

StereoPair stereo_pair() {
  StereoPair pair;
  pair.calibration = {.width_px = 240,
                      .height_px = 180,
                      .focal_px = 300,
                      .cx_px = 119.5,
                      .cy_px = 89.5,
                      .doffs_px = 4,
                      .baseline_m = 0.06,
                      .disparities_px = 48};
  pair.sensor = {.gain_e_per_dn = 12, .bits = 8};
  return pair;
}

// Lattice of 12 mm: 6 px at 0.6 m, waves of 12 px and more.
Material noisy() {
  return {.name = "noise", .bsdf = Lambert{0.9}, .texture = NoiseTexture{0.012, 1, 0.9}};
}

// Exact images (grey levels without rounding) and exact disparities.
struct Exact {
  Image<double> left, right, disparity_px;  // NaN where the pixel's centre meets nothing
};

Exact exact_images(const StereoPair& s, const RayCaster& caster) {
  const StereoCalibration& c = s.calibration;
  const Image<double> blank(c.width_px, c.height_px);
  Exact exact{blank, blank, blank};
  const std::vector<RayTruth> truth = true_rays(s, caster, Pose::Identity());
  parallel_for(truth.size(), [&](std::size_t i) {
    const int column = static_cast<int>(i) % c.width_px, row = static_cast<int>(i) / c.width_px;
    const auto grey = [&](StereoSide side) {
      return expected_electrons(s, caster, Pose::Identity(), side, column, row) /
             s.sensor.gain_e_per_dn;
    };
    exact.left.pixels[i] = grey(StereoSide::left);
    exact.right.pixels[i] = grey(StereoSide::right);
    exact.disparity_px.pixels[i] =
        c.focal_px * c.baseline_m / truth[i].point_in_scanner.z() - c.doffs_px;
  });
  return exact;
}

// Value and slope along a row by cubic convolution (Keys 1981), as the decoder interpolates.
struct Sample {
  double value, slope;
};
std::optional<Sample> sample(const Image<double>& image, double x, int row) {
  if (!(x >= margin_px && x < image.width - margin_px)) return std::nullopt;
  const int i = static_cast<int>(x);
  const double t = x - i;
  const double a = image(i - 1, row), b = image(i, row), c = image(i + 1, row),
               d = image(i + 2, row);
  const double p1 = c - a, p2 = 2 * a - 5 * b + 4 * c - d, p3 = 3 * (b - c) + d - a;
  return Sample{b + 0.5 * t * (p1 + t * (p2 + t * p3)), 0.5 * (p1 + t * (2 * p2 + t * 3 * p3))};
}

// Whether the matcher's windows about a left pixel see nothing but the surface.
bool is_inside(const Image<double>& disparity, int column, int row) {
  for (int y = row - margin_px; y <= row + margin_px; ++y)
    for (int x = column - margin_px; x <= column + margin_px; ++x) {
      if (x < 0 || x >= disparity.width || y < 0 || y >= disparity.height) return false;
      if (std::isnan(disparity(x, y))) return false;
    }
  return true;
}

// Least-squares slope of the true disparity (px per px) in a pixel's window.
Eigen::Vector2d true_slope(const Image<double>& disparity, int column, int row) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double moment = 0;
  for (int y = -half_slope_px; y <= half_slope_px; ++y)
    for (int x = -half_slope_px; x <= half_slope_px; ++x) {
      const double step = disparity(column + x, row + y) - disparity(column, row);
      sum += step * Eigen::Vector2d(x, y);
      moment += x * x;
    }
  return sum / moment;  // a full window: the moment matrix is a multiple of the identity
}

// Least squares on L(c) - R(c - d) move d by sum(g e) / sum(g^2), g the slopes of R in the window
// less their mean (the brightness difference is free), e what is left at the true disparity:
// 1. e of the exact images: the interpolation of the resampled texture, and the surface's curvature
//    inside the window, taken as they are;
// 2. rounding of both images: half a level on the left, on the right half a level times the sum of
//    absolute weights of cubic convolution, at most 1.25; in the worst combination of signs;
// 3. an error of the window's slope, at most sum |x| / sum x^2 = 3 / 13 times that of the
//    disparities it is taken from, times the distance of the texture's weight from the window's
//    centre.
// The decoder stops at steps below 1e-4 px. Where the shift is no longer small, R's slope changes
// on the way: premise.
std::optional<double> disparity_error_px(const Exact& exact, int column, int row) {
  if (!is_inside(exact.disparity_px, column, row)) return std::nullopt;
  const Eigen::Vector2d slope = true_slope(exact.disparity_px, column, row);
  std::vector<double> e, g;
  std::vector<Eigen::Vector2d> at;
  for (int y = -half_window_px; y <= half_window_px; ++y)
    for (int x = -half_window_px; x <= half_window_px; ++x) {
      const double d = exact.disparity_px(column, row) + slope.dot(Eigen::Vector2d(x, y));
      const auto seen = sample(exact.right, column + x - d, row + y);
      if (!seen) return std::nullopt;
      e.push_back(exact.left(column + x, row + y) - seen->value);
      g.push_back(seen->slope);
      at.emplace_back(x, y);
    }
  double mean = 0, texture = 0, residual = 0, rounding = 0;
  for (const double one : g) mean += one / static_cast<double>(g.size());
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < g.size(); ++i) {
    const double centred = g[i] - mean;
    texture += centred * centred;
    residual += centred * e[i];
    rounding += std::abs(centred) * (0.5 + 0.5 * 1.25);
    centre += centred * g[i] * at[i];
  }
  const double slope_part = match_error_px * 3 / 13 * centre.lpNorm<1>() / texture;
  const double error = (std::abs(residual) + rounding) / texture + slope_part + 1e-4;
  if (error > 0.5) return std::nullopt;  // hardly any texture
  return error;
}

void check_range(const Target& target, std::size_t least_points) {
  const StereoPair s = stereo_pair();
  const StereoCalibration& c = s.calibration;
  const RayCaster caster(target.scene);
  const Scan scan = acquire(render(s, caster, Pose::Identity(), {}, no_effects).frames);
  const std::vector<RayTruth> truth = true_rays(s, caster, Pose::Identity());
  const Exact exact = exact_images(s, caster);
  const auto bound_m = [&](std::size_t ray) -> std::optional<double> {
    const auto error_px = disparity_error_px(exact, static_cast<int>(ray) % c.width_px,
                                             static_cast<int>(ray) / c.width_px);
    if (!error_px) return std::nullopt;
    const double parallax_px = exact.disparity_px.pixels[ray] + c.doffs_px;
    return truth[ray].point_in_scanner.norm() * *error_px / (parallax_px - *error_px);
  };
  const RangeFigures figures = compare(
      scan, truth, [](std::size_t) { return Eigen::Vector3d(0, 0, 0); }, bound_m);
  print("stereo pair", target.name, figures);
  EXPECT_GE(figures.points, least_points);
}

// A window fattens the object by its own reach, no further: the void has no texture to match.
TEST(StereoPairRange, HasNoPointsInTheVoid) {
  const StereoPair s = stereo_pair();
  const RayCaster caster(sphere_target(0.7, 0.15, noisy()).scene);
  const Scan scan = acquire(render(s, caster, Pose::Identity(), {}, sensor_effects).frames);
  const std::vector<RayTruth> truth = true_rays(s, caster, Pose::Identity());
  const int width = s.calibration.width_px, height = s.calibration.height_px;
  for (const std::uint32_t ray : scan.ray) {
    const int column = static_cast<int>(ray) % width, row = static_cast<int>(ray) / width;
    bool is_near_object = false;
    for (int y = std::max(0, row - margin_px); y <= std::min(height - 1, row + margin_px); ++y)
      for (int x = std::max(0, column - margin_px); x <= std::min(width - 1, column + margin_px);
           ++x)
        is_near_object |= truth[y * width + x].object >= 0;
    EXPECT_TRUE(is_near_object) << "column " << column << ", row " << row;
  }
}

// Points at all but the strip that the right camera does not see, and the borders.
TEST(StereoPairRange, OfAPlaneIsExactButForRoundingAndResampling) {
  check_range(plane_target(0.6, noisy()), 25000);
}

TEST(StereoPairRange, OfASphereIsExactButForRoundingAndResampling) {
  check_range(sphere_target(0.7, 0.15, noisy()), 7500);
}

}  // namespace
}  // namespace scan::synth
