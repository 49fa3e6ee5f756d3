// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where a pulsed lidar's beams point, and how it moves from pulse to pulse.
#pragma once

#include <Eigen/Core>
#include <variant>

namespace scan::synth {

// Rows of equal elevation, columns of equal azimuth, over a field of view about +z (x right, y
// down): direction = (cos e sin a, sin e, cos e cos a) with a = width ((column + 1/2) / columns -
// 1/2) and e = height ((row + 1/2) / rows - 1/2); row 0 is the highest.
struct RasterPattern {
  int rows = 120;
  int columns = 160;
  double height_rad = 0.6;
  double width_rad = 0.8;
};
// `rows` beams fanned over the elevation, each turned through the full circle about the scanner's y
// axis: direction = (cos e sin a, -sin e, cos e cos a) with a = 2 pi column / columns and e in
// equal steps from highest_rad (row 0) to lowest_rad (last row); a single row lies in the middle.
struct SpinningPattern {
  int rows = 32;
  int columns = 720;
  double lowest_rad = -0.3;
  double highest_rad = 0.3;
};

// How the platform moves during a scan: straight with constant speed while it turns about the
// scanner's origin, both as seen from the scanner at the middle of the scan. Pulse k of n is fired
// at (k - (n - 1) / 2) interval_s; a raster fires row by row, a fan column by column.
struct LidarMotion {
  double interval_s = 0;
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();  // along the axis
  bool is_measured = false;  // the frames tell where the scanner was at each ray
};

}  // namespace scan::synth
