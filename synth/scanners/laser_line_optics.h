// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The laser-line scanner's geometry and light, shared by its renderer and its truth.
#pragma once

#include <optional>

#include "synth/scanners/laser_line.h"

namespace scan::synth {

// All in the camera frame. The sheet keeps its thickness: light at signed distance d from the plane
// comes from origin + d normal and stays in the parallel plane.
struct LaserSheet {
  Eigen::Vector3d origin;
  Eigen::Vector3d normal;  // unit; normal . x = offset on the plane
  double offset_m;
  Eigen::Vector3d middle;  // unit, of the fan's middle ray
  double half_fan_rad;
  double reach_m;  // beyond it from the plane there is less than 1e-4 electrons
};

LaserSheet laser_sheet(const LaserLine& scanner);
Eigen::Vector3d fan_direction(const LaserSheet& sheet, double angle_rad);

// Pose of the camera at each step.
std::vector<Pose> scanner_from_camera(const LaserLine& scanner);

// A ray of the sheet and where it meets the scene.
struct LitPoint {
  double angle_rad = 0;  // in the fan
  double from_plane_m = 0;
  bool is_hit = false;                              // the rest means something only then
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // where the camera would see it
  Eigen::Vector3d x_in_camera = Eigen::Vector3d::Zero();
  Hit hit = {};  // world; its normal faces the laser
};

// A camera at one of the steps with its sheet and scene.
struct LaserView {
  const LaserLine& scanner;
  const LaserSheet& sheet;
  const RayCaster& caster;
  Pose world_from_camera;

  // Not a hit either if the point is behind the camera.
  LitPoint shine(double angle_rad, double from_plane_m) const;

  // Electrons that a camera ray (z = 1, camera frame) collects from the stripe.
  double electrons(const Eigen::Vector3d& ray_in_camera) const;
};

// Number of equal steps over the fan, each at most `step_px` of the image on surfaces across the
// view.
int fan_steps(const LaserLine& scanner, double step_px);

// Marks the pixels that can receive light: 1, others 0. See laser_line_band.cpp.
Image<std::uint8_t> lit_band(const LaserView& view);

}  // namespace scan::synth
