// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where the scanner stands.
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "synth/scene.h"

namespace scan::synth {

// Positions around the world's z axis, looking at `centre_m`; x of the scanner is horizontal.
struct Turntable {  // full turn at one height: equal angles
  int count = 12;
  double radius_m = 0.4;
  double height_m = 0;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
};
struct Ring {  // an arc of a turn with both its ends, or a full turn that does not repeat its start
  int count = 8;
  double radius_m = 0.4;
  double height_m = 0;
  double start_rad = 0;
  double sweep_rad = 6.283185307179586;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
};
struct Dome {  // Fibonacci points on the upper part of a sphere, down to `lowest_rad` of elevation
  int count = 16;
  double radius_m = 0.4;
  double lowest_rad = 0;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
};
struct PoseList {
  std::vector<Pose> world_from_scanner;
};
using Layout = std::variant<Turntable, Ring, Dome, PoseList>;

// Error of the guesses that estimators get: rotation about a random axis through the scanner,
// translation in a random direction; normal, these are the standard deviations of angle and
// distance. The first scan's guess is exact: its frame is the world.
struct PoseNoise {
  double rotation_rad = 0;
  double translation_m = 0;
};

struct Viewpoints {
  Layout layout;
  PoseNoise pose_noise;
};

// Throws scan::Error (input) naming field, value and limit.
void check(const Viewpoints& viewpoints);

// Throws scan::Error (input) if one of the scanners would stand inside an opaque object: inside a
// shape, or inside a closed mesh by its winding number (Jacobson et al. 2013).
void check_standing(const Scene& scene, std::span<const Pose> world_from_scanner);

std::vector<Pose> true_poses(const Viewpoints& viewpoints);  // world_from_scanner
std::vector<Pose> guessed_poses(const Viewpoints& viewpoints, std::uint64_t seed);

}  // namespace scan::synth
