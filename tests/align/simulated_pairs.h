// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Two scans of one surface with a known pose between them, each with the noise of a kind of
// scanner: along the ray, and of a laser line or a phase camera's stray light also shared by
// neighbours.
#pragma once

#include <array>
#include <vector>

#include "libscan/align/icp.h"
#include "tests/align/test_clouds.h"

namespace scan::test {

enum class ScannerNoise {
  lidar,         // the same at every range
  stereo,        // grows with the square of the range
  phase_camera,  // grows with the inverse of the cosine of incidence
  laser_line,    // half of it shared along each line, over some points
  correlated,    // most of it shared with neighbours to all sides
  quantised,     // depths rounded to steps of four sigma
};
inline constexpr std::array scanner_noises = {ScannerNoise::lidar,        ScannerNoise::stereo,
                                              ScannerNoise::phase_camera, ScannerNoise::laser_line,
                                              ScannerNoise::correlated,   ScannerNoise::quantised};
inline const char* name_of(ScannerNoise noise) {
  constexpr const char* names[] = {"lidar",      "stereo",     "phase camera",
                                   "laser line", "correlated", "quantised"};
  return names[static_cast<int>(noise)];
}

// z(x, y) of random waves, each with a slope of about 0.3.
class WavySurface {
 public:
  explicit WavySurface(std::uint64_t seed) {
    RandomStream random(seed, 3, 0);
    for (Wave& wave : waves_) {
      const double angle = 2 * std::numbers::pi * random.uniform();
      const double per_m = 1.5 + 4.5 * random.uniform();
      wave.kx = per_m * std::cos(angle);
      wave.ky = per_m * std::sin(angle);
      wave.phase = 2 * std::numbers::pi * random.uniform();
      wave.height_m = 0.3 / per_m;
    }
  }
  double height_m(double x, double y) const {
    double z = 0;
    for (const Wave& w : waves_) z += w.height_m * std::sin(w.kx * x + w.ky * y + w.phase);
    return z;
  }
  Vector3d normal(double x, double y) const {
    Vector3d n = Vector3d::UnitZ();
    for (const Wave& w : waves_) {
      const double slope = w.height_m * std::cos(w.kx * x + w.ky * y + w.phase);
      n -= slope * Vector3d(w.kx, w.ky, 0);
    }
    return n.normalized();
  }

 private:
  struct Wave {
    double kx, ky, phase, height_m;
  };
  std::array<Wave, 4> waves_;
};

// White noise of unit variance on the scanner's grid, averaged over a window of (2 rows + 1) times
// (2 columns + 1) cells and brought back to unit variance.
inline std::vector<double> shared_noise(int side, int rows, int columns, std::uint64_t seed,
                                        std::uint32_t scan) {
  const int width = side + 2 * columns, height = side + 2 * rows;
  std::vector<double> white;
  for (int i = 0; i < width * height; ++i)
    white.push_back(RandomStream(seed, 100 + scan, std::uint64_t(i)).normal());
  std::vector<double> shared;
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      double sum = 0;
      for (int i = 0; i <= 2 * rows; ++i)
        for (int j = 0; j <= 2 * columns; ++j) sum += white[std::size_t((r + i) * width + c + j)];
      shared.push_back(sum / std::sqrt((2.0 * rows + 1) * (2.0 * columns + 1)));
    }
  return shared;
}

// How far along the ray its depth, along an axis of the scan's own that leans by some degrees, is
// from the nearest step.
inline double to_step_m(const Vector3d& arm, const Vector3d& ray, double step_m, std::uint64_t seed,
                        std::uint32_t scan) {
  RandomStream random(seed, 20 + scan, 0);
  const double x = 0.1 * random.normal(), y = 0.1 * random.normal(), start = random.uniform();
  const Vector3d axis = Vector3d(x, y, -1).normalized();
  const double steps = arm.dot(axis) / step_m + start;
  return (std::round(steps) - steps) * step_m / ray.dot(axis);
}

// In the frame of the surface: a grid of side x side rays, shaken by a third of a step, over the
// square of 2 m about `middle`, from 3 m above it.
template <class Surface>
PointCloud simulated_scan(const Surface& surface, ScannerNoise kind, double sigma_m,
                          const Vector3d& middle, int side, std::uint64_t seed,
                          std::uint32_t scan) {
  const Vector3d eye = middle + Vector3d(0, 0, 3);
  const bool lines = kind == ScannerNoise::laser_line, all = kind == ScannerNoise::correlated;
  const double shared_share = lines ? 0.5 : all ? 0.9 : 0;  // of the variance
  const std::vector<double> shared = shared_noise(side, all ? 2 : 0,
                                                  lines ? 4
                                                  : all ? 2
                                                        : 0,
                                                  seed, scan);
  PointCloud cloud;
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      const auto ray_index = std::uint64_t(r * side + c);
      RandomStream random(seed, 10 + scan, ray_index);
      const double u = random.uniform(), v = random.uniform(), own = random.normal();
      const double x = middle.x() + 2 * (c + 0.5 + (u - 0.5) / 1.5) / side - 1;
      const double y = middle.y() + 2 * (r + 0.5 + (v - 0.5) / 1.5) / side - 1;
      const Vector3d point(x, y, surface.height_m(x, y)), ray = (point - eye).normalized();
      const double range_m = (point - eye).norm();
      double sigma = sigma_m;
      if (kind == ScannerNoise::stereo) sigma *= range_m * range_m / 9;
      if (kind == ScannerNoise::phase_camera)
        sigma /= std::max(0.2, std::abs(ray.dot(surface.normal(x, y))));
      const double error_m = sigma * (std::sqrt(1 - shared_share) * own +
                                      std::sqrt(shared_share) * shared[std::size_t(ray_index)]);
      cloud.points.push_back(point + error_m * ray);
      if (kind == ScannerNoise::quantised)
        cloud.points.back() +=
            to_step_m(cloud.points.back() - eye, ray, 4 * sigma_m, seed, scan) * ray;
    }
  return cloud;
}

struct SimulatedPair {
  PointCloud source, target;
  Pose truth, guess;  // target_from_source
};

// Scans of side x side points, three quarters of which they share; the start is off by 1 degree and
// 1 cm.
inline SimulatedPair simulated_pair(ScannerNoise kind, int side, std::uint64_t seed,
                                    double noise_in_spacings = 0.125) {
  const WavySurface surface(seed);
  RandomStream random(seed, 4, 0);
  SimulatedPair pair;
  pair.truth = random_pose(random, 0.5, 1);
  pair.guess = pair.truth * random_pose(random, 0.017, 0.01);
  const double sigma_m = noise_in_spacings * 2 / side;
  pair.source = simulated_scan(surface, kind, sigma_m, {0, 0, 0}, side, seed, 0);
  pair.target =
      transformed(pair.truth, simulated_scan(surface, kind, sigma_m, {0.5, 0, 0}, side, seed, 1));
  return pair;
}

// e^T I e of the pose found: chi-square with six degrees of freedom if the information is right.
inline double normalised_error2(const IcpResult& result, const Pose& truth) {
  const Pose off = Eigen::Translation3d(-result.centre) * result.target_from_source *
                   truth.inverse() * Eigen::Translation3d(result.centre);
  const Vector6 twist = log(off);
  return twist.dot(result.information * twist);
}

}  // namespace scan::test
