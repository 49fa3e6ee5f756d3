// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Rays of a scanner, in its own frame, against the scene in the world.
#pragma once

#include <optional>

#include "synth/ray_caster.h"

namespace scan::synth {

// In the scanner frame, metres; `direction` unit.
struct ScannerRay {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};

// Where a ray first meets a surface. Point and normal are in the scanner frame, found from the
// distance along the ray, so they are as accurate far from the world's origin as at it. The normal
// is turned towards the ray's origin: a surface has two sides. `hit` is the same in the world
// frame.
struct SeenSurface {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
  Hit hit;
};

std::optional<SeenSurface> first_surface(const RayCaster& caster, const Pose& world_from_scanner,
                                         const ScannerRay& ray);

// The same as truth; of a miss the default RayTruth.
RayTruth true_ray(const RayCaster& caster, const Pose& world_from_scanner, const ScannerRay& ray);

}  // namespace scan::synth
