// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a laser head finds on its way over a plane.
#pragma once

#include <vector>

#include "libscan/acquire/stripe_bias.h"

namespace scan::decoding {

// A head that moves along x over a plane z = 1: columns and offsets are both linear.
struct Sweep {
  StripeImages frames;
  std::vector<LitRay> rays;
};

inline Sweep sweep_over_a_plane(std::size_t steps) {
  Sweep sweep;
  sweep.frames.calibration.camera = {
      .width_px = 200, .height_px = 1, .fx_px = 200, .fy_px = 200, .cx_px = 100, .cy_px = 0};
  sweep.frames.calibration.plane_normal = Eigen::Vector3d(0.8, 0, 0.6);
  sweep.frames.calibration.plane_offset_m = 0.6;  // meets z = 1 at x = 0
  for (std::size_t step = 0; step < steps; ++step) {
    const Eigen::Vector3d at(0.01 * static_cast<double>(step), 0, 0);  // two columns a step
    sweep.frames.images.emplace_back(200, 1);
    sweep.frames.scanner_from_camera.push_back(make_pose(Eigen::Matrix3d::Identity(), at));
    sweep.rays.push_back({at + Eigen::Vector3d(0, 0, 1), 100, 1.5, 1000});
  }
  return sweep;
}

// Rows of a plane that are lit alike, one behind the other.
inline Sweep sweep_over_rows(std::size_t steps, std::size_t rows) {
  Sweep one = sweep_over_a_plane(steps), all;
  all.frames = one.frames;
  all.frames.calibration.camera.height_px = static_cast<int>(rows);
  for (const LitRay& ray : one.rays) all.rays.insert(all.rays.end(), rows, ray);
  return all;
}

}  // namespace scan::decoding
