// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/point_cloud.h"

#include <string>

#include "libscan/core/error.h"

namespace scan {
namespace {

template <class T>
void check_length(const std::vector<T>& array, std::size_t points, const char* name) {
  if (array.empty() || array.size() == points) return;
  throw Error(Trouble::input, std::string("point cloud: ") + name + " has " +
                                  std::to_string(array.size()) + " entries for " +
                                  std::to_string(points) + " points");
}

template <class T>
std::vector<T> pick(const std::vector<T>& from, std::span<const std::uint32_t> indices) {
  std::vector<T> picked;
  if (from.empty()) return picked;
  picked.reserve(indices.size());
  for (const std::uint32_t i : indices) picked.push_back(from[i]);
  return picked;
}

template <class T>
void append_array(std::vector<T>& to, std::size_t to_points, const std::vector<T>& from,
                  std::size_t from_points) {
  const bool both = to.size() == to_points && from.size() == from_points;
  if (both)
    to.insert(to.end(), from.begin(), from.end());
  else
    to.clear();
}

}  // namespace

void check(const PointCloud& cloud) {
  check_length(cloud.normals, cloud.size(), "normals");
  check_length(cloud.sigma_m, cloud.size(), "sigma_m");
  check_length(cloud.covariances, cloud.size(), "covariances");
  check_length(cloud.intensity, cloud.size(), "intensity");
}

PointCloud transformed(const Pose& a_from_b, const PointCloud& cloud_in_b) {
  PointCloud cloud = cloud_in_b;
  const Eigen::Matrix3d rotation = a_from_b.linear();
  for (auto& point : cloud.points) point = a_from_b * point;
  for (auto& normal : cloud.normals) normal = rotation * normal;
  for (auto& covariance : cloud.covariances)
    covariance = rotation * covariance * rotation.transpose();
  return cloud;
}

PointCloud subset(const PointCloud& cloud, std::span<const std::uint32_t> indices) {
  return {pick(cloud.points, indices), pick(cloud.normals, indices), pick(cloud.sigma_m, indices),
          pick(cloud.covariances, indices), pick(cloud.intensity, indices)};
}

void append(PointCloud& cloud, const PointCloud& other) {
  const std::size_t m = cloud.size(), n = other.size();
  append_array(cloud.normals, m, other.normals, n);
  append_array(cloud.sigma_m, m, other.sigma_m, n);
  append_array(cloud.covariances, m, other.covariances, n);
  append_array(cloud.intensity, m, other.intensity, n);
  cloud.points.insert(cloud.points.end(), other.points.begin(), other.points.end());
}

std::vector<std::uint32_t> finite_points(const PointCloud& cloud) {
  std::vector<std::uint32_t> indices(cloud.size());
  std::size_t count = 0;
  const auto keep = [&](auto&& is_finite) {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      indices[count] = static_cast<std::uint32_t>(i);
      count += is_finite(i);
    }
  };
  // What is not finite is no longer zero when taken from itself: no branch to foretell.
  const auto all_finite = [](const Eigen::Vector3d& x) -> unsigned { return (x - x).sum() == 0; };
  if (cloud.normals.empty())
    keep([&](std::size_t i) { return all_finite(cloud.points[i]); });
  else
    keep([&](std::size_t i) { return all_finite(cloud.points[i]) & all_finite(cloud.normals[i]); });
  indices.resize(count);
  return indices;
}

Bounds bounds_of(std::span<const Eigen::Vector3d> points) {
  Bounds box;
  for (const auto& point : points)
    if (point.allFinite()) box.extend(point);
  return box;
}

}  // namespace scan
