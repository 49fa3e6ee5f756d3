// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "libscan/align/fpfh.h"
#include "libscan/core/error.h"
#include "libscan/search/kd_tree.h"
#include "libscan/search/voxel_grid.h"

namespace scan {
namespace {

constexpr double wanted_cubes = 3000;
constexpr std::size_t counted_points = 100000;
// Radii of the two descriptors in sides of a cube: 50 neighbours on a plane, and 200.
constexpr std::array<double, 2> radii_in_sides = {4, 8};

// At most so many of the cloud's finite points, spread over it: enough to count cubes by.
PointCloud thin_sample(const PointCloud& cloud) {
  const std::vector<std::uint32_t> finite = finite_points(cloud);
  const std::size_t stride = std::max<std::size_t>(1, finite.size() / counted_points);
  PointCloud few;
  for (std::size_t i = 0; i < finite.size(); i += stride)
    few.points.push_back(cloud.points[finite[i]]);
  return few;
}

// The side at which the cloud fills the wanted number of cubes, or most of its points lie in
// different ones: cubes of a surface grow in number as side^-2.
double side_of(const PointCloud& cloud) {
  const PointCloud few = thin_sample(cloud);
  const Bounds box = bounds_of(few.points);
  if (box.isEmpty() || !(box.diagonal().norm() > 0)) return 0;
  const double wanted = std::min(wanted_cubes, 0.75 * static_cast<double>(few.size()));
  double side_m = box.diagonal().norm() / std::sqrt(wanted_cubes);
  for (int round = 0; round < 4; ++round)
    side_m *= std::sqrt(static_cast<double>(voxel_grid(few, side_m).size()) / wanted);
  return side_m;
}

}  // namespace

double feature_side_m(std::span<const PointCloud> clouds) {
  std::vector<double> sides_m;
  for (const PointCloud& cloud : clouds)
    if (const double side_m = side_of(cloud); side_m > 0) sides_m.push_back(side_m);
  if (sides_m.empty()) return 0;
  const auto middle = sides_m.begin() + static_cast<std::ptrdiff_t>((sides_m.size() - 1) / 2);
  std::nth_element(sides_m.begin(), middle, sides_m.end());
  return *middle;
}

ScanFeatures describe(const PointCloud& cloud, double side_m,
                      const std::optional<Eigen::Vector3d>& viewpoint) {
  if (cloud.normals.empty() && !cloud.empty())
    throw Error(Trouble::input, "features: the cloud has no normals",
                "estimate them, facing the scanner");
  if (!(side_m > 0))
    throw Error(Trouble::usage,
                "features/side_m: " + std::to_string(side_m) + ", must be positive");
  ScanFeatures features;
  features.side_m = side_m;
  features.viewpoint = viewpoint;
  PointCloud bare;
  for (const std::uint32_t i : finite_points(cloud)) {
    if (cloud.normals[i].isZero(0)) continue;
    bare.points.push_back(cloud.points[i]);
    bare.normals.push_back(cloud.normals[i]);
  }
  if (bare.empty()) return features;
  features.cloud = voxel_grid(bare, side_m);
  const KdTree search(features.cloud.points);
  features.descriptors.resize(ScanFeatures::dimensions * features.cloud.size());
  for (std::size_t scale = 0; scale < radii_in_sides.size(); ++scale) {
    const std::vector<Fpfh> histograms =
        fpfh(features.cloud, search, radii_in_sides[scale] * side_m);
    for (std::size_t i = 0; i < histograms.size(); ++i)
      std::copy(
          histograms[i].begin(), histograms[i].end(),
          features.descriptors.begin() + static_cast<std::ptrdiff_t>(i * ScanFeatures::dimensions +
                                                                     scale * histograms[i].size()));
  }
  return features;
}

}  // namespace scan
