// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Ranging error of a simulated scanner against the truth, without noise: what discretisation alone
// costs on the road from scene to raw frames to points.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

#include "libscan/acquire/acquire.h"
#include "libscan/core/parallel.h"
#include "synth/scanner.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {

inline const EffectSet no_effects = {Effect::footprint};

// Two objects that every scanner looks at: a plane, tilted by 0.3 rad about y, and a sphere.
struct Target {
  std::string name;
  Scene scene;
};

inline Target plane_target(double z_m, const Material& material) {
  const Eigen::AngleAxisd turn(std::numbers::pi + 0.3, Eigen::Vector3d::UnitY());
  Object plane{.name = "plane",
               .world_from_object = make_pose(turn.toRotationMatrix(), {0, 0, z_m}),
               .geometry = Shape(PlaneShape{}),
               .material = 0};
  return {"plane", {.objects = {plane}, .materials = {material}}};
}

inline Target sphere_target(double z_m, double radius_m, const Material& material) {
  Object sphere{.name = "sphere",
                .world_from_object = make_pose(Eigen::Matrix3d::Identity(), {0, 0, z_m}),
                .geometry = Shape(SphereShape{radius_m}),
                .material = 0};
  return {"sphere", {.objects = {sphere}, .materials = {material}}};
}

// Of the points of a scan: root mean square and largest error along the viewing ray.
struct RangeFigures {
  std::size_t rays = 0;
  std::size_t points = 0;    // that were compared
  std::size_t left_out = 0;  // points where the bound's premises do not hold
  double rms_m = 0;
  double max_m = 0;
  double largest_bound_m = 0;
};

// The viewing ray of a point starts at `viewpoint(ray)` (scanner frame). Expects each error to be
// within `bound_m(ray)`, which gives none where it has none.
inline RangeFigures compare(const Scan& scan, const std::vector<RayTruth>& truth,
                            const std::function<Eigen::Vector3d(std::size_t)>& viewpoint,
                            const std::function<std::optional<double>(std::size_t)>& bound_m) {
  RangeFigures figures{.rays = truth.size()};
  double sum_m2 = 0;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const std::size_t ray = scan.ray[i];
    const std::optional<double> bound = bound_m(ray);
    if (!bound) {
      ++figures.left_out;
      continue;
    }
    // A NaN of a ray into nothing fails here, too.
    const Eigen::Vector3d eye = viewpoint(ray);
    const Eigen::Vector3d direction = (truth[ray].point_in_scanner - eye).normalized();
    const double error_m =
        std::abs(direction.dot(scan.cloud.points[i] - truth[ray].point_in_scanner));
    EXPECT_LE(error_m, *bound) << "ray " << ray;
    ++figures.points;
    sum_m2 += error_m * error_m;
    figures.max_m = std::max(figures.max_m, error_m);
    figures.largest_bound_m = std::max(figures.largest_bound_m, *bound);
  }
  figures.rms_m = std::sqrt(sum_m2 / static_cast<double>(figures.points));
  return figures;
}

inline void print(const char* scanner, const std::string& object, const RangeFigures& figures) {
  std::printf(
      "%-13s %-7s %6zu rays %6zu points %4zu left out  rms %9.3e m  max %9.3e m  bound %9.3e m\n",
      scanner, object.c_str(), figures.rays, figures.points, figures.left_out, figures.rms_m,
      figures.max_m, figures.largest_bound_m);
}

}  // namespace scan::synth
