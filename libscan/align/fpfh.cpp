// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/fpfh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

std::size_t bin(double value, double least, double most) {
  const double place = static_cast<double>(fpfh_bins) * (value - least) / (most - least);
  return static_cast<std::size_t>(std::clamp(place, 0.0, fpfh_bins - 1.0));
}

// Scales each of the three histograms to a sum of 100.
void normalise(Fpfh& histograms) {
  for (std::size_t first = 0; first < histograms.size(); first += fpfh_bins) {
    float sum = 0;
    for (std::size_t i = 0; i < fpfh_bins; ++i) sum += histograms[first + i];
    if (sum > 0)
      for (std::size_t i = 0; i < fpfh_bins; ++i) histograms[first + i] *= 100 / sum;
  }
}

// The simplified histograms (SPFH) of a point: its angles to each neighbour.
Fpfh simple_histograms(const PointCloud& cloud, std::size_t i, const std::vector<Neighbour>& near) {
  Fpfh histograms{};
  for (const Neighbour& other : near) {
    PairAngles angles;
    if (other.index == i ||
        !pair_angles(cloud.points[i], cloud.normals[i], cloud.points[other.index],
                     cloud.normals[other.index], angles))
      continue;
    ++histograms[bin(angles.theta_rad, -std::numbers::pi, std::numbers::pi)];
    ++histograms[fpfh_bins + bin(angles.alpha, -1, 1)];
    ++histograms[2 * fpfh_bins + bin(angles.phi, -1, 1)];
  }
  normalise(histograms);
  return histograms;
}

}  // namespace

bool pair_angles(const Eigen::Vector3d& point_1, const Eigen::Vector3d& normal_1,
                 const Eigen::Vector3d& point_2, const Eigen::Vector3d& normal_2,
                 PairAngles& angles) {
  Eigen::Vector3d d = point_2 - point_1;
  const double distance = d.norm();
  if (!(distance > 0) || normal_1.isZero(0) || normal_2.isZero(0)) return false;
  d /= distance;
  const double cosine_1 = normal_1.dot(d), cosine_2 = normal_2.dot(d);
  const bool swap = std::abs(cosine_1) < std::abs(cosine_2);
  const Eigen::Vector3d& u = swap ? normal_2 : normal_1;
  const Eigen::Vector3d& other = swap ? normal_1 : normal_2;
  if (swap) d = -d;
  Eigen::Vector3d v = d.cross(u);
  const double sine = v.norm();
  if (!(sine > 0)) return false;
  v /= sine;
  angles = {std::atan2(u.cross(v).dot(other), u.dot(other)), v.dot(other),
            swap ? -cosine_2 : cosine_1};
  return true;
}

// FPFH(p) = sum over neighbours q of SPFH(q) / |p - q|^2, normalised: the weights of PCL, which
// leaves out the point's own SPFH.
std::vector<Fpfh> fpfh(const PointCloud& cloud, const KdTree& search, double radius_m) {
  std::vector<Fpfh> simple(cloud.size()), weighted(cloud.size());
  std::vector<std::vector<Neighbour>> near(cloud.size());
  parallel_for(cloud.size(), [&](std::size_t i) {
    if (cloud.normals[i].isZero(0)) return;
    search.within(cloud.points[i], radius_m, near[i]);
    simple[i] = simple_histograms(cloud, i, near[i]);
  });
  parallel_for(cloud.size(), [&](std::size_t i) {
    for (const Neighbour& other : near[i]) {
      if (!(other.distance2_m2 > 0)) continue;
      const auto weight = static_cast<float>(radius_m * radius_m / other.distance2_m2);
      for (std::size_t k = 0; k < weighted[i].size(); ++k)
        weighted[i][k] += weight * simple[other.index][k];
    }
    normalise(weighted[i]);
  });
  return weighted;
}

}  // namespace scan
