// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/prepare_points.h"

#include <cmath>
#include <numbers>
#include <string>

#include "libscan/core/error.h"
#include "libscan/reconstruct/orientation.h"
#include "libscan/reconstruct/outliers.h"

namespace scan {
namespace {

constexpr std::size_t least_points = 4;
constexpr std::size_t neighbours = 16;
constexpr int most_rounds = 3;  // strays that hide behind strays

void keep(PreparedPoints& prepared, std::span<const std::uint32_t> kept) {
  prepared.cloud = subset(prepared.cloud, kept);
  if (prepared.viewpoints.empty()) return;
  std::vector<Eigen::Vector3d> viewpoints;
  for (const std::uint32_t i : kept) viewpoints.push_back(prepared.viewpoints[i]);
  prepared.viewpoints = std::move(viewpoints);
}

void leave_out_invalid(PreparedPoints& prepared) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < prepared.cloud.size(); ++i)
    if (prepared.cloud.points[i].allFinite()) kept.push_back(i);
  prepared.invalid_points = prepared.cloud.size() - kept.size();
  if (prepared.invalid_points > 0) keep(prepared, kept);
  if (kept.size() < least_points)
    throw Error(Trouble::input,
                "cloud: " + std::to_string(kept.size()) + " finite points, at least 4 needed");
}

LocalPlanes leave_out_outliers(PreparedPoints& prepared) {
  LocalPlanes planes = local_planes(prepared.cloud.points, neighbours);
  for (int round = 0; round < most_rounds; ++round) {
    const std::vector<char> out = outlying(planes, prepared.cloud.points);
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < out.size(); ++i)
      if (!out[i]) kept.push_back(i);
    const std::size_t left_out = out.size() - kept.size();
    if (left_out == 0 || kept.size() < least_points) break;
    prepared.outlying_points += left_out;
    keep(prepared, kept);
    planes = remaining_planes(planes, prepared.cloud.points, kept);
  }
  return planes;
}

// Unit length; a plane fit where there is none, facing its scanner if that is known.
void complete_normals(PreparedPoints& prepared, const LocalPlanes& planes) {
  std::vector<Eigen::Vector3d>& normals = prepared.cloud.normals;
  normals.resize(prepared.cloud.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double length = normals[i].norm();
    if (length > 1e-6 && std::isfinite(length)) {
      normals[i] /= length;
      continue;
    }
    normals[i] = planes.planes[i].normal;
    ++prepared.estimated_normals;
    if (!prepared.viewpoints.empty() &&
        normals[i].dot(prepared.viewpoints[i] - prepared.cloud.points[i]) < 0)
      normals[i] = -normals[i];
  }
}

}  // namespace

PreparedPoints prepare_points(const PointCloud& cloud,
                              std::span<const Eigen::Vector3d> viewpoints) {
  check(cloud);
  if (!viewpoints.empty() && viewpoints.size() != cloud.size())
    throw Error(Trouble::input, "cloud: " + std::to_string(viewpoints.size()) + " viewpoints for " +
                                    std::to_string(cloud.size()) + " points");
  PreparedPoints prepared{.cloud = cloud};
  prepared.viewpoints.assign(viewpoints.begin(), viewpoints.end());
  leave_out_invalid(prepared);
  const LocalPlanes planes = leave_out_outliers(prepared);
  complete_normals(prepared, planes);
  // A disc of the neighbours' reach holds one sample for each square of the spacing.
  for (const LocalPlane& plane : planes.planes)
    prepared.spacing_m.push_back(
        plane.reach_m * std::sqrt(std::numbers::pi / static_cast<double>(planes.neighbours)));
  prepared.turned_normals =
      agree_with_neighbours(prepared.cloud.points, planes.around, prepared.cloud.normals);
  return prepared;
}

}  // namespace scan
