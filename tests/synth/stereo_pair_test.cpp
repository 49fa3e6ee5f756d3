// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/stereo_pair.h"

#include <cmath>

#include "tests/synth/stereo_images.h"

namespace scan::synth {
namespace {

TEST(StereoPair, SeesAFacingPlaneShiftedByItsDisparity) {
  expect_shifted_copies(small_pair(), depth_of(8), 8);
}

TEST(StereoPair, CountsDisparityWithoutTheOffsetOfTheRightPrincipalPoint) {
  StereoPair pair = small_pair();
  pair.calibration.doffs_px = 3;
  expect_shifted_copies(pair, depth_of(8 + 3), 8);
}

// Catmull-Rom interpolation along a row.
double between_pixels(const Image<double>& image, double column, int row) {
  const int i = static_cast<int>(std::floor(column));
  const double t = column - i;
  const double a = image(i - 1, row), b = image(i, row), c = image(i + 1, row),
               d = image(i + 2, row);
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

// The shift that explains the left image best: least squares by Gauss-Newton, independent of any
// matcher of the library.
double correlate(const Image<double>& left, const Image<double>& right, double start_px) {
  double disparity = start_px;
  for (int iteration = 0; iteration < 20; ++iteration) {
    double slope2 = 0, slope_residual = 0;
    for (int row = 0; row < left.height; ++row)
      for (int column = 14; column < left.width - 4; ++column) {
        const double x = column - disparity;
        const double slope =
            (between_pixels(right, x + 0.01, row) - between_pixels(right, x - 0.01, row)) / 0.02;
        slope2 += slope * slope;
        slope_residual += slope * (left(column, row) - between_pixels(right, x, row));
      }
    disparity -= slope_residual / slope2;
  }
  return disparity;
}

// Noise of one octave has wavelengths from about twice its period up, here 2 x 10 px. Catmull-Rom's
// error for a wave of 20 px is at most (2 pi / 20)^3 / 24 = 1.3e-3 of its amplitude, its slope 2 pi
// / 20 of it, so the shift errs by less than 1.3e-3 / 0.31 = 4e-3 px; twice that for the weak
// overtones.
TEST(StereoPair, ShiftsByFractionsOfAPixel) {
  for (const double disparity : {7.25, 7.5, 8.8}) {
    const double z_m = depth_of(disparity);
    const Scene scene{.objects = {plane_at(z_m)}, .materials = {noisy(10 * z_m / focal_px, 1)}};
    const StereoPair pair = small_pair();
    const double found = correlate(mean_image(pair, scene, StereoSide::left),
                                   mean_image(pair, scene, StereoSide::right), 8);
    EXPECT_NEAR(found, disparity, 8e-3);
  }
}

TEST(StereoPair, TurnsAmbientLightIntoGreyByAlbedoAndGain) {
  const Scene scene{.objects = {plane_at(1, 0.7)}, .materials = {plain(0.4)}};
  const ImagePair pair = images(small_pair(), scene);
  // 0.4 * 3000 e / (40 e/DN) = 30 DN whatever the plane's tilt.
  for (const auto& image : {pair.left, pair.right})
    for (const std::uint8_t grey : image.pixels) EXPECT_EQ(grey, 30);
}

TEST(StereoPair, AveragesOverThePixelsArea) {
  StereoPair pair = small_pair();
  pair.sub_rays = 4;
  // The plate ends at column 40.3: of pixel 40, which reaches from 39.5 to 40.5, the sub-rays at
  // 39.625, 39.875 and 40.125 meet it, the one at 40.375 does not.
  const double edge_m = (40.3 - pair.calibration.cx_px) / focal_px;
  const Scene scene{.objects = {plate(1, -0.9, edge_m)}, .materials = {plain(1)}};
  const RayCaster caster(scene);
  const auto at = [&](int column) {
    return expected_electrons(pair, caster, Pose::Identity(), StereoSide::left, column, 16);
  };
  EXPECT_DOUBLE_EQ(at(39), 3000);
  EXPECT_DOUBLE_EQ(at(40), 0.75 * 3000);
  EXPECT_DOUBLE_EQ(at(41), 0);
}

// A white plate before a grey plane. Its left edge hides from the right camera a strip of the plane
// that the left camera sees, as wide as the disparities differ.
TEST(StereoPair, HidesAStripBesideAnEdgeFromOneCamera) {
  const double plate_px = 20, plane_px = 8;
  StereoPair pair = small_pair();
  const double plate_z = depth_of(plate_px);
  const double edge_px = 34.5;  // between pixels 34 and 35 of the left image
  const double edge_m = (edge_px - pair.calibration.cx_px) / focal_px * plate_z;
  const Scene scene{.objects = {plane_at(depth_of(plane_px), 0, 1), plate(plate_z, edge_m, 0.9, 0)},
                    .materials = {plain(1), plain(0.5)}};
  const Image<double> left = mean_image(pair, scene, StereoSide::left);
  const Image<double> right = mean_image(pair, scene, StereoSide::right);
  const auto strip = static_cast<int>(plate_px - plane_px);
  for (int column = 35 - strip; column < 35; ++column) {
    EXPECT_DOUBLE_EQ(left(column, 16), 1500);                                // the plane
    EXPECT_DOUBLE_EQ(right(column - static_cast<int>(plane_px), 16), 3000);  // the plate covers it
  }
  EXPECT_DOUBLE_EQ(right(34 - strip - static_cast<int>(plane_px), 16), 1500);
}

TEST(StereoPair, KnowsWhereTheCentresOfLeftPixelsEnd) {
  const StereoPair pair = small_pair();
  const Eigen::Vector3d centre(0.05, -0.02, 1);
  const Scene scene{.objects = {sphere_at(centre, 0.1)}, .materials = {plain(1)}};
  const auto rays = true_rays(pair, RayCaster(scene), Pose::Identity());
  ASSERT_EQ(rays.size(), 64u * 32u);
  int hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays[i].object < 0) {
      EXPECT_TRUE(rays[i].point_in_scanner.hasNaN());
      continue;
    }
    ++hits;
    const Eigen::Vector3d toward((static_cast<double>(i % 64) - 31.5) / focal_px,
                                 (static_cast<double>(i / 64) - 15.5) / focal_px, 1);
    const Eigen::Vector3d direction = toward.normalized();
    const Eigen::Vector3d expected = distance_to_sphere(direction, centre, 0.1) * direction;
    // The root loses half the digits at the limb: sqrt(1e-16) r at worst, 1e-12 but for the last
    // ray.
    EXPECT_LT((rays[i].point_in_scanner - expected).norm(), 1e-9);
    EXPECT_LT((rays[i].normal_in_scanner - (expected - centre) / 0.1).norm(), 1e-8);
  }
  EXPECT_NEAR(hits, std::numbers::pi * 100,
              25);  // a disc of 10 px radius, a little nearer than 1 m
}

// The scene and the pair together a million metres away: positions round to 1e-10 m there.
TEST(StereoPair, SeesTheSameFarFromTheOrigin) {
  const StereoPair pair = small_pair();
  Scene scene{.objects = {sphere_at({0.05, -0.02, 1}, 0.1)}, .materials = {plain(1)}};
  const auto here = true_rays(pair, RayCaster(scene), Pose::Identity());
  const Pose away = make_pose(Eigen::Matrix3d::Identity(), {1e6, -1e6, 1e6});
  scene.objects[0].world_from_object = away * scene.objects[0].world_from_object;
  const auto there = true_rays(pair, RayCaster(scene), away);
  std::size_t same = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (here[i].object != there[i].object) continue;  // a ray may graze the limb within 1e-10 m
    ++same;
    if (here[i].object < 0) continue;
    const double cosine = -here[i].normal_in_scanner.dot(here[i].point_in_scanner.normalized());
    EXPECT_LT((here[i].point_in_scanner - there[i].point_in_scanner).norm(), 1e-9 / cosine);
  }
  EXPECT_GE(same, here.size() - 1);
}

TEST(StereoPair, RendersTheSameBytesForAnyThreadCount) {
  StereoPair pair = with_projector();
  pair.ambient_electrons = 1000;
  const Scene scene{.objects = {plane_at(1)}, .materials = {noisy(0.05, 3)}};
  expect_same_for_any_thread_count([&] {
    const ImagePair frames = images(pair, scene, {.seed = 5, .scan = 2}, sensor_effects);
    return std::pair(frames.left.pixels, frames.right.pixels);
  });
}

// Both cameras see one grey; the chance that a pixel differs is near 1 for noise of sqrt(1200) / 40
// = 0.9 DN and more, and equal streams would give equal images.
TEST(StereoPair, GivesCamerasScansAndSeedsNoiseOfTheirOwn) {
  const Scene scene{.objects = {plane_at(1)}, .materials = {plain(0.4)}};
  const ImagePair one = images(small_pair(), scene, {.seed = 1, .scan = 0}, sensor_effects);
  EXPECT_NE(one.left.pixels, one.right.pixels);
  EXPECT_NE(one.left.pixels,
            images(small_pair(), scene, {.seed = 2, .scan = 0}, sensor_effects).left.pixels);
  EXPECT_NE(one.left.pixels,
            images(small_pair(), scene, {.seed = 1, .scan = 1}, sensor_effects).left.pixels);
}

TEST(StereoPair, SeesBlackWhereNothingIs) {
  StereoPair pair = with_projector();
  pair.ambient_electrons = 3000;
  const ImagePair frames = images(pair, Scene{});
  for (const auto& image : {frames.left, frames.right})
    for (const std::uint8_t grey : image.pixels) EXPECT_EQ(grey, 0);
  for (const RayTruth& ray : true_rays(pair, RayCaster(Scene{}), Pose::Identity()))
    EXPECT_EQ(ray.object, -1);
}

TEST(StereoPair, NamesTheFieldThatIsWrong) {
  EXPECT_EQ(complaint(small_pair()), "");
  const auto with = [](auto change) {
    StereoPair pair = small_pair();
    change(pair);
    return complaint(pair);
  };
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_EQ(with([](auto& p) { p.focus_m = 0; }),
            "stereo_pair/focus_m: 0, must be positive and finite");
  EXPECT_EQ(with([](auto& p) { p.sub_rays = 0; }), "stereo_pair/sub_rays: 0, must be from 1 to 64");
  EXPECT_EQ(with([](auto& p) { p.sensor.bits = 12; }),
            "stereo_pair/sensor.bits: 12, must be from 1 to 8");
  EXPECT_TRUE(
      has(with([](auto& p) { p.calibration.baseline_m = -0.1; }), "calibration.baseline_m: -0.1"));
  EXPECT_TRUE(has(with([](auto& p) { p.calibration.focal_px = std::nan(""); }), "focal_px: nan"));
  EXPECT_TRUE(has(with([](auto& p) { p.calibration.width_px = 0; }), "width_px: 0"));
  EXPECT_TRUE(has(with([](auto& p) { p.ambient_electrons = -1; }), "ambient_electrons: -1"));
  EXPECT_TRUE(has(with([](auto& p) { p.projector_dots = -3; }), "projector_dots: -3"));
  EXPECT_TRUE(has(with([](auto& p) { p.calibration.width_px = p.calibration.height_px = 100000; }),
                  "width_px * height_px: 1e+10 numbers, must be at most 2.14748365e+09"));
}

}  // namespace
}  // namespace scan::synth
