// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Ray against triangle in double precision, without leaks between neighbours.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <utility>

namespace scan::synth {

// A ray's shear to its largest axis (Woop, Benthin, Wald 2013, "Watertight Ray/Triangle
// Intersection"): set up once, used for many triangles.
struct ShearedRay {
  Eigen::Vector3d origin;
  double shear_x, shear_y, scale_z;
  int axis[3];
};

// Inline, and into its place: one is made for each ray.
inline void shear(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                  ShearedRay& ray) {
  const double* d = direction.data();
  int z = std::abs(d[1]) > std::abs(d[0]) ? 1 : 0;
  if (std::abs(d[2]) > std::abs(d[z])) z = 2;
  int x = z == 2 ? 0 : z + 1, y = z == 0 ? 2 : z - 1;
  if (d[z] < 0) std::swap(x, y);
  ray.origin = origin;
  ray.scale_z = 1 / d[z];
  ray.shear_x = d[x] * ray.scale_z;
  ray.shear_y = d[y] * ray.scale_z;
  ray.axis[0] = x;
  ray.axis[1] = y;
  ray.axis[2] = z;
}

// Distance along the unit direction to the triangle abc, of either sign; none if the line passes it
// by or the triangle is seen edge-on. Points on an edge belong to both of its triangles.
//
// Nothing leaks: each corner is moved into the ray's frame by the same arithmetic for all of its
// triangles, and there the sign of an edge function, a difference of two rounded products, is right
// or 0, because rounding is monotone; 0 counts as inside. Neighbours thus tile one surface, whose
// corners are off by a rounding. Where all three are small, since the triangle is thin or seen
// nearly edge-on, they are computed in twice the precision, lest zeros claim what lies beside it.
//
// The distance is off by a few roundings of the corners' distance over the cosine of incidence,
// however thin the triangle is, and always lies between its corners'.
std::optional<double> line_distance(const ShearedRay& ray, const Eigen::Vector3d& a,
                                    const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace scan::synth
