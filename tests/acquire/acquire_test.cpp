// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/acquire.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"
#include "libscan/core/units.h"
#include "tests/acquire/readings.h"
#include "tests/acquire/stereo_scene.h"

namespace scan {
namespace {

// One small noisy recording per device, each of a wall at 0.3 to 3 m, some rays without signal.

StripeImages stripes() {
  StripeImages frames;
  frames.calibration.camera = {
      .width_px = 160, .height_px = 40, .fx_px = 200, .fy_px = 200, .cx_px = 80, .cy_px = 20};
  frames.calibration.plane_normal = Eigen::Vector3d(1, 0, 0.5).normalized();
  frames.calibration.plane_offset_m = 0.1;
  for (int step = 0; step < 6; ++step) {
    Image<std::uint16_t> image(160, 40);
    for (int row = 0; row < 40; ++row) {
      RandomStream random(61, step, row);
      for (int column = 0; column < 160; ++column)
        image(column, row) = test::noisy(
            {}, 20 + (row > 4 ? 600 : 0) * test::bell(column - 60.3 - 0.2 * row, 1.7), random);
    }
    frames.images.push_back(image);
    frames.scanner_from_camera.push_back(
        make_pose(Eigen::Matrix3d::Identity(), {0.002 * step, 0, 0}));
  }
  return frames;
}

ImagePair pair() {
  return test::render(
      test::Texture(7), [](double x, double) { return 12 + 0.03 * x; }, 160, 80, 32, 2);
}

PhaseTaps taps() {
  PhaseTaps frames;
  frames.calibration.camera = {
      .width_px = 40, .height_px = 30, .fx_px = 50, .fy_px = 50, .cx_px = 20, .cy_px = 15};
  frames.calibration.frequencies_hz = {80e6, 100e6};
  frames.calibration.max_range_m = 7;
  frames.taps.resize(2);
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 4; ++k) {
      frames.taps[f][k] = Image<std::uint16_t>(40, 30);
      for (std::size_t i = 0; i < 1200; ++i) {
        RandomStream random(62, 4 * f + k, i);
        const double phase =
            4 * M_PI * frames.calibration.frequencies_hz[f] * 3 / speed_of_light_m_s + k * M_PI / 2;
        frames.taps[f][k].pixels[i] =
            test::noisy({}, 2000 + (i % 7 == 0 ? 0 : 1000) * std::cos(phase), random);
      }
    }
  return frames;
}

Waveforms pulses() {
  Waveforms frames;
  frames.grid = {20, 30};
  frames.samples_per_ray = 60;
  for (int ray = 0; ray < 600; ++ray) {
    RandomStream random(63, 0, ray);
    frames.directions.push_back(
        Eigen::Vector3d(0.01 * (ray % 30 - 15), 0.01 * (ray / 30 - 10), 1).normalized());
    for (int i = 0; i < 60; ++i)
      frames.samples.push_back(
          test::noisy({}, 10 + (ray % 11 == 0 ? 0 : 500) * test::bell(i - 20.4, 2), random));
  }
  return frames;
}

std::vector<RawFrames> devices() {
  return {stripes(), pair(), taps(), pulses()};
}
constexpr std::size_t rays_of[] = {6 * 40, 160 * 80, 40 * 30, 20 * 30};

TEST(Acquire, EveryRayIsAPointOrAMissForEachDevice) {
  const auto all = devices();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Scan scan = acquire(all[i]);
    std::size_t rays = scan.cloud.size();
    for (const auto& [reason, count] : scan.misses) rays += count;
    EXPECT_EQ(rays, rays_of[i]);
    EXPECT_GT(scan.cloud.size(), rays_of[i] / 2);
    EXPECT_EQ(std::size_t{scan.grid.rows} * scan.grid.columns, rays_of[i]);
    EXPECT_EQ(scan.ray.size(), scan.cloud.size());
    EXPECT_TRUE(std::is_sorted(scan.ray.begin(), scan.ray.end()));
    EXPECT_NO_THROW(check(scan.cloud));
    EXPECT_EQ(scan.cloud.normals.size(), scan.cloud.size());
  }
}

TEST(Acquire, PointsHaveSigmaAndNormalsFaceTheDevice) {
  for (const RawFrames& frames : devices()) {
    const Scan scan = acquire(frames);
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      EXPECT_TRUE(scan.cloud.points[i].allFinite());
      EXPECT_TRUE(scan.cloud.sigma_m[i] > 0 && scan.cloud.sigma_m[i] < 0.5);
      EXPECT_TRUE(scan.cloud.covariances[i].allFinite());
      EXPECT_LE(scan.cloud.normals[i].dot(scan.cloud.points[i]),
                1e-3);  // cameras lie within 0.01 m
    }
  }
}

template <class T>
void append(std::string& bytes, const std::vector<T>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

std::string bytes_of(const Scan& scan) {
  std::string bytes;
  append(bytes, scan.cloud.points);
  append(bytes, scan.cloud.normals);
  append(bytes, scan.cloud.sigma_m);
  append(bytes, scan.cloud.covariances);
  append(bytes, scan.cloud.intensity);
  append(bytes, scan.ray);
  for (const auto& [reason, count] : scan.misses) bytes += reason + std::to_string(count);
  return bytes;
}

TEST(Acquire, IsTheSameForAnyNumberOfThreads) {
  for (const RawFrames& frames : devices()) {
    std::string first;
    for (const int threads : {1, 2, 7}) {
      const ThreadLimit limit(threads);
      const std::string bytes = bytes_of(acquire(frames));
      if (first.empty()) first = bytes;
      EXPECT_TRUE(bytes == first) << frames.index() << " with " << threads;
    }
  }
}

}  // namespace
}  // namespace scan
