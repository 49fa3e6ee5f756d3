// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where a pulsed lidar's beams point, and the rays that stand for a beam's cross-section.
#pragma once

#include <vector>

#include "synth/scanners/pulsed_lidar.h"

namespace scan::synth {

RayGrid ray_grid(const PulsedLidar& scanner);
// Unit directions in the scanner frame, one per ray, row by row.
std::vector<Eigen::Vector3d> ray_directions(const PulsedLidar& scanner);

// The frame of the scan (that of the scanner at the middle of the scan) from the scanner as it
// fires a ray.
Pose scan_from_scanner(const PulsedLidar& scanner, std::size_t ray);
bool is_moving(const PulsedLidar& scanner);

// A ray of the beam's cross-section and the share of the energy that it carries; the shares add
// to 1.
struct BeamRay {
  Eigen::Vector3d origin;     // scanner frame, metres
  Eigen::Vector3d direction;  // unit
  double share = 1;
};

// The cross-section of all beams, in units of D(R). Ring k has 2k + 1 rays, each with 1 /
// sub_rays^2 of the energy; the rays are skew lines of one-sheeted hyperboloids, so at every
// distance R they stand where the Gaussian of radius D(R) wants them, and their mean square
// distance from the axis is that of the Gaussian, D^2 / 2.
struct BeamSection {
  std::vector<Eigen::Vector2d> places;
  double rim = 0;  // radius of the outermost ring
  double exit_radius_m = 0;
  double slope = 0;  // tan(divergence / 2)

  BeamRay ray(const Eigen::Vector3d& axis, const Eigen::Vector2d& place) const;
};
BeamSection beam_section(const PulsedLidar& scanner);

// All of them about the axis `direction` (unit).
std::vector<BeamRay> beam_rays(const PulsedLidar& scanner, const Eigen::Vector3d& direction);

}  // namespace scan::synth
