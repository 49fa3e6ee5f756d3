// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The compactly supported, positive definite radial function of Wendland (1995), C4 in space.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace scan {

// phi(t) = (1 - t)^6 (35 t^2 + 18 t + 3) / 3 for t < 1, else 0, at an offset d of length t:
// gradient slope d, Hessian slope I + bend d d^T.
struct Wendland {
  double value = 0, slope = 0, bend = 0;
};

inline constexpr double wendland_curvature = 56.0 / 3;  // -slope at 0

inline Wendland wendland(double t2) {
  const double t = std::sqrt(t2), s = 1 - t, s2 = s * s, s4 = s2 * s2;
  return {s4 * s2 * (35 * t2 + 18 * t + 3) / 3, -wendland_curvature * s4 * s * (1 + 5 * t),
          560 * s4};
}

// A value and a gradient: of a function at a place, or of a node's share in a sum.
struct Jet {
  double value = 0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();

  Jet& operator+=(const Jet& other) {
    value += other.value;
    gradient += other.gradient;
    return *this;
  }
  double dot(const Jet& other) const { return value * other.value + gradient.dot(other.gradient); }
};

inline Jet operator*(double factor, const Jet& jet) {
  return {factor * jet.value, factor * jet.gradient};
}

// What a node of share c adds at an offset d (length below 1) from it: value and gradient of
// c.value phi - c.gradient . grad phi. With white c this is the covariance of values and gradients
// of a random function of covariance phi, so the matrix between nodes is positive definite.
inline Jet influence(const Jet& c, const Eigen::Vector3d& d, double d2) {
  const Wendland w = wendland(d2);
  const double along = c.gradient.dot(d);
  return {c.value * w.value - w.slope * along,
          (c.value * w.slope - w.bend * along) * d - w.slope * c.gradient};
}

}  // namespace scan
