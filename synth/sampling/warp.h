// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// From the unit square to disks, spheres and lobes, each map with its density.
//
// `u` is in [0, 1)^2. Directions are unit, z is up (the normal). Densities are per area of the unit
// disk or per steradian, and 0 outside the map's range.
#pragma once

#include <Eigen/Core>

namespace scan::synth {

Eigen::Vector2d to_disk(const Eigen::Vector2d& u);  // concentric (Shirley and Chiu 1997)
double disk_density(const Eigen::Vector2d& point);

Eigen::Vector3d to_sphere(const Eigen::Vector2d& u);
double sphere_density();

Eigen::Vector3d to_hemisphere(const Eigen::Vector2d& u);
double hemisphere_density(const Eigen::Vector3d& direction);

Eigen::Vector3d to_cosine_hemisphere(const Eigen::Vector2d& u);
double cosine_hemisphere_density(const Eigen::Vector3d& direction);

// Microfacet normals of Beckmann's distribution, density D(h) cos(h) (Walter et al. 2007, eq. 28).
Eigen::Vector3d to_beckmann_normal(const Eigen::Vector2d& u, double roughness);
double beckmann_normal_density(const Eigen::Vector3d& normal, double roughness);

// GGX normals visible from `out` (z > 0), density G1(out) D(h) max(0, out.h) / out.z (Heitz 2018).
Eigen::Vector3d to_ggx_visible_normal(const Eigen::Vector2d& u, const Eigen::Vector3d& out,
                                      double roughness);
double ggx_visible_normal_density(const Eigen::Vector3d& normal, const Eigen::Vector3d& out,
                                  double roughness);

}  // namespace scan::synth
