// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/stereo.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/acquire/reason.h"
#include "libscan/core/error.h"
#include "libscan/core/units.h"
#include "tests/acquire/stereo_scene.h"

namespace scan {
namespace {

constexpr int width = 240, height = 120, disparities = 48;

// Places where the windows of matcher and refinement lie within both images.
bool is_inner(int x, int y) {
  return x > disparities + 8 && x < width - 8 && y > 8 && y < height - 8;
}

struct Statistics {
  double inner = 0, found = 0, within_2_sigma = 0, within_4_sigma = 0, mean_square_px2 = 0;
};

Statistics compare(const DisparityMap& map, const test::Disparity& truth) {
  Statistics result;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!is_inner(x, y)) continue;
      ++result.inner;
      if (std::isnan(map.disparity_px(x, y))) continue;
      const double error = std::abs(map.disparity_px(x, y) - truth(x, y));
      ++result.found;
      result.within_2_sigma += error < 2 * map.sigma_px(x, y);
      result.within_4_sigma += error < 4 * map.sigma_px(x, y);
      result.mean_square_px2 += error * error;
    }
  result.mean_square_px2 /= result.found;
  return result;
}

double slanted(double x, double y) {
  return 20 + 0.05 * (x - 120) - 0.08 * (y - 60);
}
// A sphere of radius 0.6 m, its centre 1.7 m in front of the camera: Z = f B / (d + doffs), here f
// B = 50.
double bulging(double x, double y) {
  const double u = (x - 119.5) / 500, v = (y - 59.5) / 500;
  const double a = u * u + v * v + 1, half_b = 1.7, c = 1.7 * 1.7 - 0.36;
  const double inside = std::max(half_b * half_b - a * c, 0.0);
  return 50 * a / (half_b - std::sqrt(inside)) - 5;
}

// Noise-free: what is left is the rounding (sigma 0.29 in both images), the cubic convolution and
// the straight disparity within a window. A third of the matcher's step of 1/16 px proves the
// refinement: the matcher itself errs by 0.1 px here.
TEST(Stereo, RecoversAPlaneAndASphereBelowTheMatchersStep) {
  const test::Texture texture(1);
  for (const test::Disparity& truth : {test::Disparity(slanted), test::Disparity(bulging)}) {
    const Statistics result =
        compare(match(test::render(texture, truth, width, height, disparities, 0)), truth);
    EXPECT_GT(result.found / result.inner, 0.99);
    EXPECT_LT(std::sqrt(result.mean_square_px2), 1.0 / 48);
  }
}

// Of normal errors 95.4 % lie within 2 sigma and all but 6e-5 within 4. The residual's variance is
// taken from 49 pixels (10 %) and the windows overlap, so some 400 of them are independent: 4
// sqrt(0.95 * 0.05 / 400) = 4 %.
TEST(Stereo, ReportsItsScatter) {
  const test::Texture texture(2);
  for (const double noise : {2.0, 6.0}) {
    const Statistics result =
        compare(match(test::render(texture, slanted, width, height, disparities, noise)), slanted);
    EXPECT_GT(result.found / result.inner, 0.98);
    EXPECT_NEAR(result.within_2_sigma / result.found, 0.954, 0.04);
    EXPECT_GT(result.within_4_sigma / result.found, 0.995);
  }
}

TEST(Stereo, EveryPixelIsAPointOrAMiss) {
  const Scan scan =
      acquire_stereo(test::render(test::Texture(3), slanted, width, height, disparities, 1));
  std::size_t rays = scan.cloud.size();
  for (const auto& [reason, count] : scan.misses) rays += count;
  EXPECT_EQ(rays, std::size_t{width} * height);
  EXPECT_EQ(scan.grid.rows, std::uint32_t{height});
  EXPECT_EQ(scan.grid.columns, std::uint32_t{width});
  EXPECT_EQ(scan.cloud.intensity.size(), scan.cloud.size());
  EXPECT_EQ(scan.noise_window.rows, 7u);  // of blocks of 5
  EXPECT_EQ(scan.noise_window.columns, 7u);
}

// Left pixels whose partner lies outside the right image, more than a pixel: some 1,600.
TEST(Stereo, EndsAtTheBorderOfTheRightImage) {
  const DisparityMap map =
      match(test::render(test::Texture(3), slanted, width, height, disparities, 1));
  int unseen = 0, wrong = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < slanted(x, y) - 1; ++x) {
      ++unseen;
      wrong += !std::isnan(map.disparity_px(x, y));
    }
  EXPECT_LT(wrong, 0.1 * unseen);
  EXPECT_GT(map.misses.at(std::string(reason::border)), unseen / 5u);
}

// A flat patch of 40 x 30 px, the blocks on its rim see texture.
TEST(Stereo, HasNoSignalWithoutTexture) {
  ImagePair pair = test::render(
      test::Texture(3), [](double, double) { return 10.0; }, 160, 60, 32, 0);
  for (int y = 15; y < 45; ++y)
    for (int x = 80; x < 120; ++x) pair.left(x, y) = pair.right(x - 10, y) = 90;
  const DisparityMap map = match(pair);
  EXPECT_TRUE(std::isnan(map.disparity_px(100, 30)));
  EXPECT_GE(map.misses.at(std::string(reason::no_signal)), 35u * 26u);
}

// Two images of different things: hardly a match survives, most fail for want of a unique one.
TEST(Stereo, IsAmbiguousWhereNothingMatches) {
  ImagePair pair = test::render(test::Texture(3), slanted, 160, 60, 32, 0);
  for (std::size_t i = 0; i < pair.left.pixels.size(); ++i) {
    RandomStream random(42, 0, i);
    pair.left.pixels[i] = test::grey(128 + 40 * random.normal());
    pair.right.pixels[i] = test::grey(128 + 40 * random.normal());
  }
  const DisparityMap map = match(pair);
  EXPECT_GT(map.misses.at(std::string(reason::ambiguous)), 160u * 60u * 2 / 3);
  const auto matched = std::count_if(map.disparity_px.pixels.begin(), map.disparity_px.pixels.end(),
                                     [](float d) { return !std::isnan(d); });
  EXPECT_LT(matched, 160 * 60 / 20);
}

// A square 20 px nearer hides a strip of 20 px at its left side from the right camera: in the left
// image those pixels have no true partner.
TEST(Stereo, IsInconsistentWhereTheRightCameraSeesNothing) {
  const test::Texture near(4), far(5);
  ImagePair pair = test::render(
      far, [](double, double) { return 10.0; }, width, height, 48, 0);
  for (int y = 30; y < 90; ++y)
    for (int x = 120; x < 180; ++x) {
      pair.left(x, y) = test::grey(near(x, y));
      pair.right(x - 30, y) = test::grey(near(x, y));
    }
  const DisparityMap map = match(pair);
  int hidden = 0;
  for (int y = 35; y < 85; ++y)
    for (int x = 104; x < 116; ++x) hidden += std::isnan(map.disparity_px(x, y));
  EXPECT_GT(hidden, 50 * 12 * 0.9);
  EXPECT_GT(map.misses.at(std::string(reason::inconsistent)), 100u);
}

// Golden values: f = 640 px, B = 50 mm, sigma_d = 0.08 px.
TEST(StereoPoints, FollowTheQuadraticLaw) {
  const StereoCalibration calibration{.width_px = 4,
                                      .height_px = 1,
                                      .focal_px = 640,
                                      .cx_px = 0,
                                      .cy_px = 0,
                                      .doffs_px = 0,
                                      .baseline_m = 0.05};
  DisparityMap map{Image<float>(4, 1), Image<float>(4, 1, 0.08f), {}};
  const double depths_m[] = {0.5, 1, 2, 4}, sigmas_mm[] = {0.625, 2.5, 10, 40};
  for (int i = 0; i < 4; ++i) map.disparity_px(i, 0) = static_cast<float>(32 / depths_m[i]);
  const Scan scan = points_from(map, calibration);
  ASSERT_EQ(scan.cloud.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(scan.cloud.points[i].z(), depths_m[i], 1e-6);
    EXPECT_NEAR(mm_from_m(std::sqrt(scan.cloud.covariances[i](2, 2))), sigmas_mm[i],
                1e-4 * sigmas_mm[i]);
    const Eigen::Vector3d ray = scan.cloud.points[i].normalized();
    EXPECT_NEAR(std::sqrt(ray.dot(scan.cloud.covariances[i] * ray)), scan.cloud.sigma_m[i], 1e-12);
  }
}

// The map's own differences: move the disparity by a little, the point moves by sqrt(covariance).
TEST(StereoPoints, CovarianceIsTheDerivative) {
  const StereoCalibration calibration{.width_px = 3,
                                      .height_px = 2,
                                      .focal_px = 500,
                                      .cx_px = -40,
                                      .cy_px = 70,
                                      .doffs_px = 7,
                                      .baseline_m = 0.2};
  DisparityMap map{Image<float>(3, 2, 20), Image<float>(3, 2, 0.125f), {}};
  const Scan scan = points_from(map, calibration);
  map.disparity_px.pixels.assign(6, 20.0625f);
  const Scan more = points_from(map, calibration);
  map.disparity_px.pixels.assign(6, 19.9375f);
  const Scan less = points_from(map, calibration);
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d shift = less.cloud.points[i] - more.cloud.points[i];  // 0.125 px
    EXPECT_LT(
        (shift * shift.transpose() - scan.cloud.covariances[i]).norm(),
        1e-4 * scan.cloud.covariances[i].norm());  // (0.0625 / 27)^2 = 5e-6, doubled by squaring
  }
}

TEST(StereoPoints, DepthIsUndeterminedNearInfinity) {
  const StereoCalibration calibration{.width_px = 5,
                                      .height_px = 1,
                                      .focal_px = 500,
                                      .cx_px = 0,
                                      .cy_px = 0,
                                      .doffs_px = -3,
                                      .baseline_m = 0.2};
  DisparityMap map{Image<float>(5, 1), Image<float>(5, 1, 0.1f), {{"border", 1}}};
  map.disparity_px.pixels = {2, 3, 3.25, 3.5, std::nanf("")};
  const Scan scan = points_from(map, calibration);
  EXPECT_EQ(scan.cloud.size(), 1u);
  EXPECT_EQ(scan.misses.at(std::string(reason::undetermined)), 3u);
  EXPECT_EQ(scan.misses.at("border"), 1u);
  EXPECT_EQ(scan.misses.size(), 2u);
}

TEST(Stereo, SigmaOfTheCallerReplacesTheEstimate) {
  const DisparityMap map =
      match(test::render(test::Texture(3), slanted, 120, 60, 48, 0), {.disparity_sigma_px = 0.25});
  for (std::size_t i = 0; i < map.sigma_px.pixels.size(); ++i)
    EXPECT_TRUE(std::isnan(map.disparity_px.pixels[i]) ? std::isnan(map.sigma_px.pixels[i])
                                                       : map.sigma_px.pixels[i] == 0.25f);
}

TEST(Stereo, RefusesBrokenPairs) {
  const ImagePair good = test::render(test::Texture(3), slanted, 64, 20, 32, 0);
  ImagePair pair = good;
  pair.right = Image<std::uint8_t>(3, 3);
  EXPECT_THROW(match(pair), Error);
  pair = good;
  pair.calibration.baseline_m = 0;
  EXPECT_THROW(match(pair), Error);
  pair = good;
  pair.calibration.disparities_px = 0;
  EXPECT_THROW(match(pair), Error);
  EXPECT_THROW(match(good, {.block_px = 4}), Error);
  pair = test::render(test::Texture(3), slanted, 1, 1, 16, 0);
  EXPECT_EQ(match(pair).disparity_px.pixels.size(), 1u);
}

}  // namespace
}  // namespace scan
