// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Surfaces with noisy samples, and fits of them that are known in closed form.
#pragma once

#include <cmath>

#include "libscan/core/random.h"
#include "libscan/reconstruct/bilateral_samples.h"

namespace scan::bilateral {

inline constexpr double spacing = 0.01, sigma = 0.25 * spacing, fitted_length = 1.2 * spacing;
inline constexpr int side = 80;

// Samples and what a fit says at them.
struct Case {
  Samples samples;
  FittedSamples fit;
};

// A roof z = -slope |x|, sampled at random with noise along its normals, and a fit of it that
// rounds the ridge off as the hyperbola z = -slope sqrt(x^2 + length^2).
inline Case roof(double slope, double length) {
  Case result;
  Samples& s = result.samples;
  const Eigen::Vector3d middle(0.5, 0.5, 0.5);
  for (int i = 0; i < side * side; ++i) {
    RandomStream random(1, 0, static_cast<std::uint64_t>(i));
    const double x = (random.uniform() - 0.5) * side * spacing / std::hypot(1, slope);
    const double y = (random.uniform() - 0.5) * side * spacing;
    const double noise = sigma * random.normal();
    const Eigen::Vector3d up = Eigen::Vector3d(std::copysign(slope, x), 0, 1).normalized();
    const Eigen::Vector3d p = Eigen::Vector3d(x, y, -slope * std::abs(x)) + noise * up;
    const double root = std::hypot(p[0], length);
    const Eigen::Vector3d normal = Eigen::Vector3d(slope * p[0] / root, 0, 1).normalized();
    s.points.push_back(middle + p);
    s.normals.push_back(up);
    result.fit.normals.push_back(normal);
    result.fit.feet.push_back(middle + p - (p[2] + slope * root) * normal[2] * normal);
  }
  s.area.assign(s.points.size(), spacing * spacing);
  s.sigma.assign(s.points.size(), sigma);
  result.fit.length.assign(s.points.size(), fitted_length);
  result.fit.trust.assign(s.points.size(), 1.0);
  return result;
}

// Half a plane, then waves of wave number k and height h that begin with slope 0.
inline double height_of_waves(double x, double h, double k) {
  return x > 0.5 ? h * (1 - std::cos(k * (x - 0.5))) : 0;
}

// As the roof; its fit lies half a spacing below, so that any average is better.
inline Case waves(double h, double k, double length) {
  Case result = roof(0, 0);
  for (std::size_t i = 0; i < result.samples.points.size(); ++i) {
    Eigen::Vector3d &p = result.samples.points[i], &foot = result.fit.feet[i];
    const double slope = p[0] > 0.5 ? h * k * std::sin(k * (p[0] - 0.5)) : 0;
    const double up = height_of_waves(p[0], h, k);
    p[2] += up;
    foot = {p[0], p[1], 0.5 + up - spacing / 2};
    result.samples.normals[i] = result.fit.normals[i] = Eigen::Vector3d(-slope, 0, 1).normalized();
  }
  result.fit.length.assign(result.samples.points.size(), length);
  return result;
}

}  // namespace scan::bilateral
