// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The stereo pair's dot projector.
#include <cmath>

#include "tests/synth/stereo_images.h"

namespace scan::synth {
namespace {

// The dots lie on the surface, not in the images.
TEST(StereoPair, SeesTheProjectedDotsFromBothCameras) {
  StereoPair pair = small_pair();
  pair.projector_electrons = 3000;
  pair.projector_dots = 32;
  expect_shifted_copies(pair, depth_of(8), 8);
  pair.ambient_electrons = 0;
  expect_shifted_copies(pair, depth_of(8), 8);
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

}  // namespace
}  // namespace scan::synth
