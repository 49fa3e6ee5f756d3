// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The laser-line scanner's geometry and light, shared by its renderer and its truth.
#pragma once

#include "synth/effects/effect.h"
#include "synth/scanners/laser_line.h"

namespace scan::synth {

// The device with the fields of all effects that are off set to ideal. What follows obeys the
// fields alone.
LaserLine with_effects(const LaserLine& device, const EffectSet& effects);

// All in the camera frame. Light at signed distance d from the plane comes from origin + d normal
// and stays in the parallel plane; its share thins out as the beam spreads.
struct LaserSheet {
  Eigen::Vector3d origin;
  Eigen::Vector3d normal;  // unit; normal . x = offset on the plane
  double offset_m;
  Eigen::Vector3d middle;  // unit, of the fan's middle ray
  double half_fan_rad;
  double focus_m;      // from the laser, where the beam is thinnest
  double waist_m;      // 1/e^2 radius there
  double rayleigh_m;   // infinite: no spread
  double bow_slope;    // out of the plane, of the rays at the fan's ends
  double reach_radii;  // beyond so many radii from the plane there is less than 1e-4 electrons

  // 1/e^2 radius at a distance from the laser (Gaussian beam, Siegman 1986, sec. 17.1).
  double radius_m(double from_laser_m) const;
  // Slope of the light out of the plane: quadratic over the fan.
  double slope_at(double angle_rad) const;
};

LaserSheet laser_sheet(const LaserLine& scanner);
Eigen::Vector3d fan_direction(const LaserSheet& sheet, double angle_rad);  // unit

// Pose of the camera, in the scanner's frame, so many steps after the middle of the sweep.
Pose stage_pose(const LaserLine& scanner, double steps);
// Pose of the camera at each step.
std::vector<Pose> scanner_from_camera(const LaserLine& scanner);

// A ray of the sheet and where it meets the scene.
struct SheetHit {
  double angle_rad = 0;  // in the fan
  double from_plane_m = 0;
  double time_steps = 0;                            // of the stage, after the exposure's middle
  bool is_hit = false;                              // the rest means something only then
  bool is_lit = false;                              // within the beam's reach there
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // where the camera would see it
  Eigen::Vector3d x_in_camera = Eigen::Vector3d::Zero();
  Hit hit = {};  // world; its normal faces the laser
};

// A way of light into the camera, backwards: camera frame, unit direction.
struct CameraRay {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};

// Mean electrons of a pixel or ray: the laser's light shows speckle, other light does not.
struct PixelLight {
  double laser_e = 0;
  double other_e = 0;
};

// A camera at one of the steps with its sheet and scene.
struct LaserView {
  const LaserLine& scanner;
  const LaserSheet& sheet;
  const RayCaster& caster;
  Pose world_from_camera;

  // The view so many steps of the stage later.
  LaserView after(double time_steps) const;

  // Not a hit either if the point is behind the camera.
  SheetHit shine(double angle_rad, double from_plane_m) const;

  // What a camera ray collects by direct light.
  PixelLight light(const CameraRay& ray) const;
};

// Irradiance of the sheet at a point of the camera frame on a surface that faces the light there,
// in electrons of a white Lambert surface, and where it comes from; none outside fan and reach.
struct SheetLight {
  double irradiance_e = 0;
  Eigen::Vector3d source = Eigen::Vector3d::Zero();
};
SheetLight sheet_light(const LaserLine& scanner, const LaserSheet& sheet,
                       const Eigen::Vector3d& x_in_camera);

// Number of equal steps over the fan, each at most `step_px` of the image on surfaces across the
// view.
int fan_steps(const LaserLine& scanner, double step_px);

// Marks the pixels that can receive direct light: 1, others 0. See laser_line_band.cpp.
Image<std::uint8_t> lit_band(const LaserView& view);

}  // namespace scan::synth
