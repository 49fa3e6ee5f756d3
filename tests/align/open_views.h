// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Several scans of surfaces that leave motions open, from guesses whose errors are known.
#pragma once

#include <array>
#include <cmath>

#include "tests/align/simulated_views.h"

namespace scan::test {

enum class OpenShape {
  plane,     // two slides, a turn
  sphere,    // three turns
  cylinder,  // a slide, a turn
  prism,     // a slide
};
inline constexpr std::array open_shapes = {OpenShape::plane, OpenShape::sphere, OpenShape::cylinder,
                                           OpenShape::prism};
inline const char* name_of(OpenShape shape) {
  constexpr const char* names[] = {"plane", "sphere", "cylinder", "prism"};
  return names[static_cast<int>(shape)];
}
inline int open_motions(OpenShape shape) {
  constexpr int counts[] = {3, 3, 2, 1};
  return counts[static_cast<int>(shape)];
}

// z(x, y) about the middle of the four scans of simulated_views.
class OpenSurface {
 public:
  OpenSurface(OpenShape shape, std::uint64_t seed) : shape_(shape), waves_(seed) {}
  double height_m(double x, double y) const {
    const double u = x - 0.35, v = y - 0.35;
    switch (shape_) {
      case OpenShape::plane:
        return 0.1 * u - 0.2 * v;
      case OpenShape::sphere:
        return std::sqrt(16 - u * u - v * v) - 4;
      case OpenShape::cylinder:
        return std::sqrt(9 - v * v) - 3;
      case OpenShape::prism:
        break;
    }
    return waves_.height_m(x, 0);
  }
  Vector3d normal(double x, double y) const {  // by differences; noise's share of the slope is tiny
    const double h_m = 1e-4;
    return Vector3d(height_m(x - h_m, y) - height_m(x + h_m, y),
                    height_m(x, y - h_m) - height_m(x, y + h_m), 2 * h_m)
        .normalized();
  }

 private:
  OpenShape shape_;
  WavySurface waves_;
};

// As GuessSigma has it.
inline Pose drawn_guess(const Pose& truth, const GuessSigma& sigma, RandomStream& random) {
  const Vector3d axis = random_direction(random), way = random_direction(random);
  const double angle_rad = sigma.rotation_rad * random.normal();
  const double length_m = sigma.translation_m * random.normal();
  return make_pose(Eigen::AngleAxisd(angle_rad, axis) * truth.linear(),
                   truth.translation() + length_m * way);
}

struct OpenViews {
  SimulatedViews views;
  MultiviewOptions options;  // that know of the guesses' errors
};

// Four scans as those of simulated_views; the guesses are off by 0.6 degrees and 1 cm, that of the
// anchor only if `anchor_off`.
inline OpenViews open_views(OpenShape shape, int side, std::uint64_t seed, bool anchor_off) {
  const OpenSurface surface(shape, seed);
  const GuessSigma off{.rotation_rad = 0.01, .translation_m = 0.01};
  OpenViews set;
  for (std::uint32_t i = 0; i < 4; ++i) {
    RandomStream random(seed, 5, i);
    const Vector3d middle(0.7 * (i % 2), 0.7 * (i / 2), 0);
    const Pose truth = random_pose(random, 0.5, 1);
    const GuessSigma sigma = i > 0 || anchor_off ? off : GuessSigma{};
    set.views.truth.push_back(truth);
    set.views.guesses.push_back(drawn_guess(truth, sigma, random));
    set.options.guess_sigmas.push_back(sigma);
    PointCloud cloud =
        simulated_scan(surface, ScannerNoise::lidar, 0.25 / side, middle, side, seed, i);
    estimate_normals(cloud, [](const Vector3d&) { return Vector3d::UnitZ(); });
    set.views.clouds.push_back(transformed(truth.inverse(), cloud));
  }
  return set;
}

}  // namespace scan::test
