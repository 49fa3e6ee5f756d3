// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Points with what a scanner knows of each.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libscan/core/pose.h"

namespace scan {

using Bounds = Eigen::AlignedBox3d;

// `points` in metres. Each further array is empty or has one entry per point.
struct PointCloud {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;      // unit, towards the scanner; (0,0,0): unknown
  std::vector<double> sigma_m;               // 1 sigma along the viewing ray
  std::vector<Eigen::Matrix3d> covariances;  // m^2, same frame as the points
  std::vector<double> intensity;             // device units

  std::size_t size() const { return points.size(); }
  bool empty() const { return points.empty(); }
};

// Throws scan::Error (input) if an array is neither empty nor as long as `points`.
void check(const PointCloud& cloud);

// The cloud in frame a: points, normals and covariances are carried over.
PointCloud transformed(const Pose& a_from_b, const PointCloud& cloud_in_b);

// The points of the given indices (each below cloud.size()), in their order.
PointCloud subset(const PointCloud& cloud, std::span<const std::uint32_t> indices);

// Adds the points of `other` behind those of `cloud`. An array that one side lacks is dropped.
void append(PointCloud& cloud, const PointCloud& other);

// Indices of the points whose coordinates (and normal, if there are normals) are all finite.
std::vector<std::uint32_t> finite_points(const PointCloud& cloud);

// Smallest box around the finite points; empty for none.
Bounds bounds_of(std::span<const Eigen::Vector3d> points);

}  // namespace scan
