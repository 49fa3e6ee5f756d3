// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/stereo_pair.h"

#include <cmath>

#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

constexpr double focal_px = 100;
constexpr double baseline_m = 0.1;

StereoPair small_pair() {
  StereoPair pair;
  pair.calibration = {.width_px = 64,
                      .height_px = 32,
                      .focal_px = focal_px,
                      .cx_px = 31.5,
                      .cy_px = 15.5,
                      .baseline_m = baseline_m,
                      .disparities_px = 32};
  return pair;
}

double depth_of(double disparity_px) {
  return focal_px * baseline_m / disparity_px;
}

Material noisy(double period_m, int octaves) {
  return {.name = "noise", .albedo = 0.8, .texture = NoiseTexture{period_m, octaves, 0.8}};
}

ImagePair images(const StereoPair& pair, const Scene& scene, const RenderAddress& address = {},
                 const DetectorEffects& effects = noise_free) {
  return std::get<ImagePair>(render(pair, RayCaster(scene), Pose::Identity(), address, effects));
}

// The mean electrons of one camera's image, before the detector.
Image<double> mean_image(const StereoPair& pair, const Scene& scene, StereoSide side) {
  const RayCaster caster(scene);
  Image<double> image(pair.calibration.width_px, pair.calibration.height_px);
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column)
      image(column, row) = expected_electrons(pair, caster, Pose::Identity(), side, column, row);
  return image;
}

double mean_of(const Image<double>& image) {
  double sum = 0;
  for (const double value : image.pixels) sum += value;
  return sum / static_cast<double>(image.pixels.size());
}

// A left pixel's rays and those of the right pixel d further left end on the same places of a plane
// at Z = f B / (d + doffs), up to rounding (1e-15 m); the texture's slope is below 3000 e / 1e-3 m,
// that of the dots below 2 * 3000 e / 8e-3 m.
void expect_shifted_copies(const StereoPair& pair, double z_m, int disparity_px) {
  const Scene scene{.objects = {plane_at(z_m)}, .materials = {noisy(0.05, 4)}};
  const Image<double> left = mean_image(pair, scene, StereoSide::left);
  const Image<double> right = mean_image(pair, scene, StereoSide::right);
  double contrast = 0;
  for (int row = 0; row < left.height; ++row)
    for (int column = disparity_px; column < left.width; ++column) {
      EXPECT_NEAR(left(column, row), right(column - disparity_px, row), 1e-7);
      contrast = std::max(contrast, std::abs(left(column, row) - left(disparity_px, row)));
    }
  EXPECT_GT(contrast, 300) << "a plain image would be a copy at each shift";
}

TEST(StereoPair, SeesAFacingPlaneShiftedByItsDisparity) {
  expect_shifted_copies(small_pair(), depth_of(8), 8);
}

// The dots lie on the surface, not in the images.
TEST(StereoPair, SeesTheProjectedDotsFromBothCameras) {
  StereoPair pair = small_pair();
  pair.projector_electrons = 3000;
  pair.projector_dots = 32;
  expect_shifted_copies(pair, depth_of(8), 8);
  pair.ambient_electrons = 0;
  expect_shifted_copies(pair, depth_of(8), 8);
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

StereoPair with_projector() {
  StereoPair pair = small_pair();
  pair.calibration.focal_px = 1000;  // a narrow field: cosine and distance vary by less than 1e-3
  pair.ambient_electrons = 0;
  pair.projector_electrons = 2000;
  pair.projector_dots = 64;
  pair.sub_rays = 6;
  return pair;
}

// A cell is dark or, with probability 1/2, holds a dot that covers 0.09 pi of it; (1 - q)^2 has the
// mean 1/3 over a disc. So the mean is 0.09 pi / 6 and the deviation of a cell as large again. The
// image covers 64 x 32 cells: 1 sigma = 1 / sqrt(2048) = 2.2 %; 4 sigma. (6 x 6 rays a cell sample
// the dots' mean without bias, since the dots lie anywhere.)
TEST(StereoPair, ProjectsDotsOfTheStatedDensity) {
  const double mean_pattern = 0.09 * std::numbers::pi / 6;
  const Scene facing{.objects = {plane_at(1)}, .materials = {plain(1)}};
  const double mean = mean_of(mean_image(with_projector(), facing, StereoSide::left));
  EXPECT_NEAR(mean / (2000 * mean_pattern), 1, 4 / std::sqrt(2048));

  const Scene tilted{.objects = {plane_at(1, std::numbers::pi / 3)}, .materials = {plain(1)}};
  const double oblique = mean_of(mean_image(with_projector(), tilted, StereoSide::left));
  EXPECT_NEAR(oblique / (2000 * mean_pattern), 0.5, 2 * 4 / std::sqrt(2048));
}

// Scene and baseline twice as large: every ray meets the same place of the pattern at twice the
// distance, and a quarter of the light comes back.
TEST(StereoPair, DimsTheProjectorByTheSquareOfTheDistance) {
  const StereoPair near_pair = with_projector();
  StereoPair far_pair = near_pair;
  far_pair.calibration.baseline_m *= 2;
  const auto at_distance = [](double z_m) {
    return Scene{.objects = {plane_at(z_m)}, .materials = {plain(1)}};
  };
  const Image<double> near_image = mean_image(near_pair, at_distance(1), StereoSide::right);
  const Image<double> far_image = mean_image(far_pair, at_distance(2), StereoSide::right);
  for (std::size_t i = 0; i < near_image.pixels.size(); ++i)
    EXPECT_NEAR(far_image.pixels[i], near_image.pixels[i] / 4, 1e-8);
}

// As in HidesAStripBesideAnEdgeFromOneCamera with the projector, half a baseline to the right, as
// the second camera: the strip is half as wide.
TEST(StereoPair, CastsTheProjectorsShadow) {
  StereoPair pair = small_pair();
  pair.projector_electrons = 5000;
  pair.projector_dots = 32;
  const double plate_z = depth_of(20), plane_z = depth_of(8);
  const double edge_m = (34.5 - pair.calibration.cx_px) / focal_px * plate_z;
  const Scene scene{.objects = {plane_at(plane_z), plate(plate_z, edge_m, 0.9)},
                    .materials = {plain(0.5)}};
  const Image<double> left = mean_image(pair, scene, StereoSide::left);
  double brightest_outside = 0;
  for (int row = 0; row < left.height; ++row) {
    for (int column = 29; column < 35; ++column) EXPECT_DOUBLE_EQ(left(column, row), 1500);
    for (int column = 23; column < 28; ++column)  // dark if the projector were in the right camera
      brightest_outside = std::max(brightest_outside, left(column, row));
  }
  EXPECT_GT(brightest_outside, 1800);
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
    const ImagePair frames = images(pair, scene, {.seed = 5, .scan = 2}, {});
    return std::pair(frames.left.pixels, frames.right.pixels);
  });
}

// Both cameras see one grey; the chance that a pixel differs is near 1 for noise of sqrt(1200) / 40
// = 0.9 DN and more, and equal streams would give equal images.
TEST(StereoPair, GivesCamerasScansAndSeedsNoiseOfTheirOwn) {
  const Scene scene{.objects = {plane_at(1)}, .materials = {plain(0.4)}};
  const ImagePair one = images(small_pair(), scene, {.seed = 1, .scan = 0}, {});
  EXPECT_NE(one.left.pixels, one.right.pixels);
  EXPECT_NE(one.left.pixels, images(small_pair(), scene, {.seed = 2, .scan = 0}, {}).left.pixels);
  EXPECT_NE(one.left.pixels, images(small_pair(), scene, {.seed = 1, .scan = 1}, {}).left.pixels);
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
