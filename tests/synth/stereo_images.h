// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A small stereo pair and its images.
#pragma once

#include <algorithm>
#include <cmath>

#include "tests/synth/scanner_scenes.h"

namespace scan::synth {

inline constexpr double focal_px = 100;
inline constexpr double baseline_m = 0.1;

inline StereoPair small_pair() {
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

inline double depth_of(double disparity_px) {
  return focal_px * baseline_m / disparity_px;
}

inline Material noisy(double period_m, int octaves) {
  return {.name = "noise", .bsdf = Lambert{0.8}, .texture = NoiseTexture{period_m, octaves, 0.8}};
}

inline ImagePair images(const StereoPair& pair, const Scene& scene,
                        const RenderAddress& address = {}, const EffectSet& effects = noise_free) {
  return std::get<ImagePair>(
      render(pair, RayCaster(scene), Pose::Identity(), address, effects).frames);
}

// The mean electrons of one camera's image, before the detector.
inline Image<double> mean_image(const StereoPair& pair, const Scene& scene, StereoSide side) {
  const RayCaster caster(scene);
  Image<double> image(pair.calibration.width_px, pair.calibration.height_px);
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column)
      image(column, row) = expected_electrons(pair, caster, Pose::Identity(), side, column, row);
  return image;
}

inline double mean_of(const Image<double>& image) {
  double sum = 0;
  for (const double value : image.pixels) sum += value;
  return sum / static_cast<double>(image.pixels.size());
}

// A left pixel's rays and those of the right pixel d further left end on the same places of a plane
// at Z = f B / (d + doffs), up to rounding (1e-15 m); the texture's slope is below 3000 e / 1e-3 m,
// that of the dots below 2 * 3000 e / 8e-3 m.
inline void expect_shifted_copies(const StereoPair& pair, double z_m, int disparity_px) {
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

inline StereoPair with_projector() {
  StereoPair pair = small_pair();
  pair.calibration.focal_px = 1000;  // a narrow field: cosine and distance vary by less than 1e-3
  pair.ambient_electrons = 0;
  pair.projector_electrons = 2000;
  pair.projector_dots = 64;
  pair.sub_rays = 6;
  return pair;
}

}  // namespace scan::synth
