// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Small scenes with closed-form answers, and what every scanner's test asks.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "synth/scanner.h"

namespace scan::synth {

inline const EffectSet noise_free = {Effect::quantisation, Effect::footprint};
inline const EffectSet sensor_effects = {Effect::shot_noise, Effect::read_noise,
                                         Effect::quantisation, Effect::footprint};

inline Material plain(double albedo) {
  return {.name = "plain", .bsdf = Lambert{albedo}, .texture = {}};
}

// A half-space whose surface meets the z axis at z_m. It faces a scanner at the origin that looks
// along +z, turned by tilt_rad about the y axis.
inline Object plane_at(double z_m, double tilt_rad = 0, int material = 0) {
  const Eigen::AngleAxisd turn(std::numbers::pi + tilt_rad, Eigen::Vector3d::UnitY());
  return {.name = "plane",
          .world_from_object = make_pose(turn.toRotationMatrix(), {0, 0, z_m}),
          .geometry = Shape(PlaneShape{}),
          .material = material};
}

// A thin plate in z = z_m, in front of the scanner, from left_m to right_m and 2 m high.
inline Object plate(double z_m, double left_m, double right_m, int material = 0) {
  Mesh mesh;
  mesh.vertices = {{left_m, -1, z_m}, {right_m, -1, z_m}, {right_m, 1, z_m}, {left_m, 1, z_m}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return {.name = "plate",
          .world_from_object = Pose::Identity(),
          .geometry = mesh,
          .material = material};
}

inline Object sphere_at(const Eigen::Vector3d& centre, double radius_m, int material = 0) {
  return {.name = "sphere",
          .world_from_object = make_pose(Eigen::Matrix3d::Identity(), centre),
          .geometry = Shape(SphereShape{radius_m}),
          .material = material};
}

// Distance along a unit direction from the origin to a sphere in front of it: the smaller root of
// |t d - c|^2 = r^2.
inline double distance_to_sphere(const Eigen::Vector3d& direction, const Eigen::Vector3d& centre,
                                 double radius_m) {
  const double along = direction.dot(centre);
  const double across2 = (centre - along * direction).squaredNorm();
  return along - std::sqrt(radius_m * radius_m - across2);
}

// The message of the error that check() throws; empty if it throws none.
template <class Device>
std::string complaint(const Device& device) {
  try {
    check(device);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

// Runs `work` under 1, 2 and 7 threads and expects the same result each time.
template <class Work>
void expect_same_for_any_thread_count(const Work& work) {
  const auto once = [&](int threads) {
    const ThreadLimit limit(threads);
    return work();
  };
  const auto alone = once(1);
  EXPECT_EQ(alone, once(2));
  EXPECT_EQ(alone, once(7));
}

}  // namespace scan::synth
