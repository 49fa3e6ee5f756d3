// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A rectangle as seen from a point: its solid angle, and directions drawn evenly from it.
#pragma once

#include <Eigen/Core>

namespace scan::synth {

// In the rectangle's frame: the rectangle spans +-half_size_m in the plane z = 0 and is seen from
// x, x.z > 0.
struct SphericalRectangle {
  SphericalRectangle(const Eigen::Vector2d& half_size_m, const Eigen::Vector3d& x_in_rectangle);

  // The seen point for u in [0, 1)^2 such that its direction is even by solid angle (Urena,
  // Fajardo, King 2013, "An Area-Preserving Parametrization for Spherical Rectangles"). Below
  // 1e-4 sr, where the angles' sum loses its digits, even by area.
  Eigen::Vector2d point(const Eigen::Vector2d& u) const;
  // Of point(), per sr, at a point of the rectangle.
  double density(const Eigen::Vector2d& point) const;

  double solid_angle_sr;

 private:
  Eigen::Vector2d half_, low_, high_;  // low_, high_: corners as seen from x
  double z_;                           // of the plane as seen from x, negative
  double b0_, b1_, k_;                 // of the paper's listing 1
  bool by_area_;
};

}  // namespace scan::synth
