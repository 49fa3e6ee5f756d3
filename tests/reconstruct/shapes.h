// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Oriented samples of shapes with a closed form, for the tests of this folder.
#pragma once

#include <cmath>
#include <numbers>

#include "libscan/core/point_cloud.h"
#include "libscan/core/random.h"
#include "libscan/reconstruct/sample_term.h"

namespace scan {

inline PointCloud sphere_cloud(std::size_t count, double radius_m = 1, std::uint64_t seed = 1) {
  PointCloud cloud;
  RandomStream random(seed, 0, 0);
  while (cloud.size() < count) {
    const Eigen::Vector3d v(random.normal(), random.normal(), random.normal());
    cloud.normals.push_back(v.normalized());
    cloud.points.push_back(radius_m * cloud.normals.back());
  }
  return cloud;
}

// Uniform by area: the tube angle is accepted with the density of its ring's length.
inline PointCloud torus_cloud(std::size_t count, double major_m = 1, double minor_m = 0.35,
                              std::uint64_t seed = 2) {
  PointCloud cloud;
  RandomStream random(seed, 0, 0);
  while (cloud.size() < count) {
    const double u = 2 * std::numbers::pi * random.uniform();
    const double v = 2 * std::numbers::pi * random.uniform();
    if (random.uniform() > (major_m + minor_m * std::cos(v)) / (major_m + minor_m)) continue;
    const Eigen::Vector3d ring(std::cos(u), std::sin(u), 0);
    cloud.normals.push_back(std::cos(v) * ring + std::sin(v) * Eigen::Vector3d::UnitZ());
    cloud.points.push_back(major_m * ring + minor_m * cloud.normals.back());
  }
  return cloud;
}

// Exact samples of the unit sphere with bumps along its radius: 1 + height_m sin(k x) sin(k y)
// sin(k z), x on the unit sphere, with the normals of that surface.
inline PointCloud bumpy_cloud(std::size_t count, double height_m, double k,
                              std::uint64_t seed = 1) {
  PointCloud cloud = sphere_cloud(count, 1, seed);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d x = cloud.normals[i];
    const Eigen::Array3d s = (k * x.array()).sin(), c = (k * x.array()).cos();
    const Eigen::Vector3d slope =
        height_m * k * Eigen::Vector3d(c[0] * s[1] * s[2], s[0] * c[1] * s[2], s[0] * s[1] * c[2]);
    const double radius = 1 + height_m * s.prod();
    cloud.points[i] = radius * x;
    cloud.normals[i] = (radius * x - (slope - slope.dot(x) * x)).normalized();
  }
  return cloud;
}

// Moved by sigma in each coordinate; the normals stay.
inline PointCloud scattered(PointCloud cloud, double sigma_m, std::uint64_t seed = 3) {
  RandomStream random(seed, 0, 0);
  for (auto& point : cloud.points)
    for (int a = 0; a < 3; ++a) point[a] += sigma_m * random.normal();
  return cloud;
}

// Sums of `value` and `gradient`, shared out by area.
inline SampleWeights even_weights(const Samples& samples, double value, double gradient) {
  double total = 0;
  for (const double area : samples.area) total += area;
  SampleWeights weights;
  for (const double area : samples.area) {
    weights.value.push_back(value * area / total);
    weights.gradient.push_back(gradient * area / total);
  }
  return weights;
}

}  // namespace scan
