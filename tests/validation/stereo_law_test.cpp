// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A stereo pair's error against distance: sigma_Z = Z^2 sigma_d / (f B), its bias, and what light
// adds to a bare wall.
#include <algorithm>
#include <cmath>

#include "tests/validation/scanner_range.h"

namespace scan::synth {
namespace {

// f = 640 px, B = 50 mm, sigma_d = 0.08 px; the law's values at 0.5, 1, 2 and 4 m are 0.625, 2.5,
// 10 and 40 mm, its bias Z (sigma_d / d)^2 = 0.05 mm at 2 m and 0.4 mm at 4 m.
struct Moments {
  double mean_m, sigma_m, told_m;
};

Moments decode_noisy(double z_m) {
  const StereoCalibration c{.width_px = 512,
                            .height_px = 512,
                            .focal_px = 640,
                            .cx_px = 255.5,
                            .cy_px = 255.5,
                            .baseline_m = 0.05,
                            .disparities_px = 128};
  DisparityMap map;
  map.disparity_px = map.sigma_px = Image<float>(c.width_px, c.height_px);
  RandomStream random(5, 1, static_cast<std::uint64_t>(z_m * 8));
  for (std::size_t i = 0; i < map.disparity_px.pixels.size(); ++i) {
    map.disparity_px.pixels[i] =
        static_cast<float>(c.focal_px * c.baseline_m / z_m + 0.08 * random.normal());
    map.sigma_px.pixels[i] = 0.08f;
  }
  const Scan scan = points_from(map, c);
  double sum = 0, squares = 0, told = 0;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const Eigen::Vector3d& point = scan.cloud.points[i];
    sum += point.z();
    squares += (point.z() - z_m) * (point.z() - z_m);
    told += scan.cloud.sigma_m[i] * point.z() / point.norm();
  }
  const auto n = static_cast<double>(scan.cloud.size());
  return {sum / n, std::sqrt(squares / n), told / n};
}

// n = 262144: a standard deviation is known to 1 / sqrt(2 n) = 0.14 %, a mean to sigma / 512; four
// of them. The next order of the law is (sigma_d / d)^2, at 4 m 1e-4; the bias's next 3 (sigma_d /
// d)^4 Z.
TEST(StereoLaw, GrowsWithTheSquareOfTheDistanceAndIsBiased) {
  for (const double z_m : {0.5, 1.0, 2.0, 4.0}) {
    const double sigma_m = z_m * z_m * 0.08 / (640 * 0.05);
    const Moments found = decode_noisy(z_m);
    const double share = sigma_m / z_m;
    const double bias_m = z_m * share * share;
    std::printf("  %.1f m: sigma %.4f mm (law %.4f), bias %.4f mm (law %.4f)\n", z_m,
                found.sigma_m * 1e3, sigma_m * 1e3, (found.mean_m - z_m) * 1e3, bias_m * 1e3);
    EXPECT_NEAR(found.sigma_m / sigma_m, 1, 4 * 0.0014 + 8 * share * share);
    EXPECT_NEAR(found.told_m / sigma_m, 1, 4 * 0.0014 + 8 * share * share);
    EXPECT_NEAR(found.mean_m - z_m, bias_m, 4 * sigma_m / 512 + 3 * bias_m * share * share);
  }
  // seen against zero bias at 4 m: 0.4 mm over 40 mm / 512
  EXPECT_GT(decode_noisy(4).mean_m - 4, 3 * 0.04 / 512);
}

StereoPair lit_pair() {
  StereoPair pair;
  pair.calibration = {.width_px = 240,
                      .height_px = 160,
                      .focal_px = 300,
                      .cx_px = 119.5,
                      .cy_px = 79.5,
                      .baseline_m = 0.06,
                      .disparities_px = 48};
  pair.sensor = {.gain_e_per_dn = 40, .read_noise_e = 10, .full_well_e = 10200, .bits = 8};
  return pair;
}

// Root mean square error of Z on a facing wall of the texture, in the image's middle.
double error_m(const StereoPair& pair, double z_m, const Texture& texture) {
  const Scene scene{.objects = {plane_at(z_m)},
                    .materials = {{.name = "wall", .bsdf = Lambert{0.8}, .texture = texture}}};
  const Scan scan = acquire(
      render(pair, RayCaster(scene), Pose::Identity(), {.seed = 9, .scan = 0}, sensor_effects)
          .frames);
  double squares = 0;
  for (const Eigen::Vector3d& point : scan.cloud.points)
    squares += (point.z() - z_m) * (point.z() - z_m);
  return std::sqrt(squares / static_cast<double>(scan.cloud.size()));
}

// With the same texture in pixels sigma_d is the same at each distance, so the error's slope
// against distance is 2 in logarithms. 30000 matches with windows of 25 px are 1200 of their own:
// each error is known to 1 / sqrt(2400) = 2 %; over a factor of 3 the slope errs by sqrt(2) 2 % /
// ln 3 = 0.026; four of that.
TEST(StereoLaw, HoldsThroughRenderingAndMatching) {
  const StereoPair pair = lit_pair();
  const auto at = [&](double z_m) {
    return error_m(pair, z_m, NoiseTexture{8 * z_m / pair.calibration.focal_px, 1, 0.9});
  };
  const double near_m = at(0.5), far_m = at(1.5);
  const double slope = std::log(far_m / near_m) / std::log(3.0);
  std::printf("  0.5 m: %.3f mm, 1.5 m: %.3f mm, slope %.3f\n", near_m * 1e3, far_m * 1e3, slope);
  EXPECT_NEAR(slope, 2, 4 * 0.026);
}

double matched_share(const StereoPair& pair) {
  const Scene wall{.objects = {plane_at(0.9)}, .materials = {plain(0.8)}};
  const Scan scan = acquire(
      render(pair, RayCaster(wall), Pose::Identity(), {.seed = 9, .scan = 0}, sensor_effects)
          .frames);
  std::size_t right = 0;  // within a tenth of the distance
  for (const Eigen::Vector3d& point : scan.cloud.points) right += std::abs(point.z() - 0.9) < 0.09;
  return static_cast<double>(right) / (240.0 * 160.0);
}

// A bare wall gives no match; projected dots make it one. Left of the search range (20 px of 240)
// and beside the borders (windows of 9 px) there is none: 85 % of the image is left.
TEST(StereoLaw, SeesABareWallByItsDots) {
  StereoPair pair = lit_pair();
  EXPECT_LT(matched_share(pair), 0.01);
  pair.projector_electrons = 6000;
  pair.projector_dots = 80;
  const double share = matched_share(pair);
  std::printf("  matched: %.1f %% with dots\n", share * 100);
  EXPECT_GT(share, 0.8);
}

// A device of the first Kinect's published figures (640 x 480 pixels, f = 580 px, B = 75 mm,
// infrared dots) against its axial noise after Khoshelham and Oude Elberink (2012), sigma
// = 1.425e-5 Z^2 cm, which stands for half a pixel of its normalised disparity. Here a second
// camera takes the place of the stored pattern, and the exposure follows the distance, as the
// device's gain does: what is left is the matcher on dots. Our windows are 5 x 5 where the device
// correlates over 9 x 9 and 9 x 7 and rounds to an eighth of a pixel, so only the law and the size
// are held: the square of the distance within 0.3 in the exponent, the curve within a factor of 3.
// The residual is printed.
TEST(KinectV1, ApproachesItsPublishedNoise) {
  const auto sigma_m = [](double z_m) {
    StereoPair pair;
    pair.calibration = {.width_px = 320,
                        .height_px = 120,
                        .focal_px = 580,
                        .cx_px = 159.5,
                        .cy_px = 59.5,
                        .baseline_m = 0.075,
                        .disparities_px = 64};
    pair.sensor = {.gain_e_per_dn = 20, .read_noise_e = 15, .full_well_e = 5100, .bits = 8};
    pair.ambient_electrons = 100;
    pair.focus_m = z_m;
    pair.projector_electrons = 3000;
    pair.projector_dots = 100;  // 3 px each
    const Scene wall{.objects = {plane_at(z_m)}, .materials = {plain(0.6)}};
    const Scan scan = acquire(
        render(pair, RayCaster(wall), Pose::Identity(), {.seed = 4, .scan = 0}, sensor_effects)
            .frames);
    std::vector<double> errors;
    for (const Eigen::Vector3d& point : scan.cloud.points)
      errors.push_back(std::abs(point.z() - z_m));
    EXPECT_GT(errors.size(), 320u * 120u / 2);
    // of a normal distribution 68.3 % are within one sigma; wrong matches do not count
    const std::size_t one_sigma = errors.size() * 683 / 1000;
    std::nth_element(errors.begin(), errors.begin() + static_cast<long>(one_sigma), errors.end());
    return errors[one_sigma];
  };
  const double published_m2 = 1.425e-3;  // 1.425e-5 per cm
  double first_m = 0, last_m = 0;
  for (const double z_m : {1.0, 2.0, 3.0}) {
    const double found_m = sigma_m(z_m), published_m = published_m2 * z_m * z_m;
    std::printf("  %.0f m: %.2f mm, published %.2f mm, ratio %.2f\n", z_m, found_m * 1e3,
                published_m * 1e3, found_m / published_m);
    EXPECT_GT(found_m, published_m / 3);
    EXPECT_LT(found_m, published_m * 3);
    (z_m == 1 ? first_m : last_m) = found_m;
  }
  EXPECT_NEAR(std::log(last_m / first_m) / std::log(3.0), 2, 0.3);
}

}  // namespace
}  // namespace scan::synth
