// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pairs of clouds whose relative pose is known exactly, made from real scans: the points of one
// scan are shared out at random between two that have none in common, opposite ends are cut off,
// noise is added, and one is moved.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "libscan/core/point_cloud.h"
#include "libscan/core/random.h"
#include "libscan/core/units.h"
#include "libscan/io/image_file.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"

namespace scan::test {

struct PairCase {
  std::string name;
  PointCloud source, target;                                // points alone
  Pose truth = Pose::Identity(), guess = Pose::Identity();  // target_from_source
  double thin_m = 0;                                        // voxels to thin both by; 0: not at all
  double reach_m = 0;                                       // greatest pair distance for the peers
  double step_m = 0;                                        // of the peers' NDT grid
};

struct Splitting {
  double noise_m = 0;
  double thin_m = 0;  // 0: not at all
  double overlap = 0.7;
  double start_deg = 3, start_m = 0;
};

inline std::filesystem::path shared_data() {
  return std::filesystem::path(LIBSCAN_SOURCE_DIR) / "../shared/data";
}

inline Eigen::Vector3d random_direction(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return Eigen::Vector3d(x, y, z).normalized();
}

inline Pose random_motion(RandomStream& random, double angle_deg, double shift_m) {
  const Eigen::Vector3d axis = random_direction(random), shift = shift_m * random_direction(random);
  return make_pose(Eigen::AngleAxisd(rad_from_deg(angle_deg), axis).toRotationMatrix(), shift);
}

inline Eigen::Vector3d centroid(const PointCloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& x : cloud.points) sum += x;
  return sum / static_cast<double>(cloud.size());
}

// One half of the points, without the `cut` share of them at one end of the longest axis.
inline PointCloud half_of(const PointCloud& cloud, bool first, const Splitting& how,
                          std::uint64_t seed) {
  Eigen::Index axis = 0;
  bounds_of(cloud.points).sizes().maxCoeff(&axis);
  std::vector<double> along;
  for (const Eigen::Vector3d& x : cloud.points) along.push_back(x[axis]);
  std::sort(along.begin(), along.end());
  const auto cut = static_cast<std::size_t>((1 - how.overlap) / 2 * double(along.size()));
  const double low = along[first ? 0 : cut], high = along[along.size() - 1 - (first ? cut : 0)];
  PointCloud half;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    RandomStream random(seed, 0, i);
    const bool is_first = random.uniform() < 0.5;
    const Eigen::Vector3d& x = cloud.points[i];
    if (is_first != first || x[axis] < low || x[axis] > high) continue;
    const double a = random.normal(), b = random.normal(), c = random.normal();
    half.points.push_back(x + how.noise_m * Eigen::Vector3d(a, b, c));
  }
  return half;
}

// The guess is off by the given turn about the source's centroid, and by the shift.
inline PairCase split_pair(const std::string& name, const PointCloud& cloud, const Splitting& how,
                           std::uint64_t seed) {
  RandomStream random(seed, 1, 0);
  PairCase made{.name = name, .thin_m = how.thin_m};
  made.source = half_of(cloud, true, how, seed);
  made.truth = random_motion(random, 25, 0);
  made.target = transformed(made.truth, half_of(cloud, false, how, seed));
  const Eigen::Vector3d centre = centroid(made.source);
  made.guess = made.truth * Eigen::Translation3d(centre) *
               random_motion(random, how.start_deg, how.start_m) * Eigen::Translation3d(-centre);
  return made;
}

inline PointCloud points_of(const std::filesystem::path& file) {
  PointCloud cloud;
  cloud.points = read_scan(file).cloud.points;
  return cloud;
}

// camera_primesense.json of redwood-rgbd: focal length 525 px, principal point (319.5, 239.5).
inline PointCloud depth_frame(const std::filesystem::path& file) {
  const Image<std::uint16_t> depth_mm = read_grey16(file);
  PointCloud cloud;
  for (int v = 0; v < depth_mm.height; ++v)
    for (int u = 0; u < depth_mm.width; ++u) {
      const double z_m = 1e-3 * depth_mm(u, v);
      if (z_m > 0) cloud.points.emplace_back(z_m * (u - 319.5) / 525, z_m * (v - 239.5) / 525, z_m);
    }
  return cloud;
}

// Of every kind of data there is. Noise, thinning and starts of the first three are those of the
// published comparison; reconbench's shapes have no unit and an extent of about 100.
inline std::vector<PairCase> split_pairs(double overlap, std::uint64_t seed) {
  const auto data = shared_data();
  std::vector<PairCase> pairs;
  const auto add = [&](const char* name, const PointCloud& cloud, Splitting how, double reach_m,
                       double step_m) {
    how.overlap = overlap;
    pairs.push_back(split_pair(name, cloud, how, seed));
    pairs.back().reach_m = reach_m;
    pairs.back().step_m = step_m;
  };
  add("lidar", points_of(data / "lidar-small_gicp/target.ply"),
      {.noise_m = 0.01, .thin_m = 0.25, .start_deg = 3, .start_m = 0.3}, 1, 1);
  add("bunny", points_of(data / "stanford-bunny/data/bun000.ply"),
      {.noise_m = 1e-4, .start_deg = 5, .start_m = 5e-3}, 0.01, 0.01);
  add("depth", depth_frame(data / "redwood-rgbd/depth/00000.png"),
      {.noise_m = 2e-3, .thin_m = 0.01, .start_deg = 3, .start_m = 0.05}, 0.1, 0.2);
  for (const char* name : {"anchor", "lordquas"})
    add(name, points_of(data / "reconbench/derived" / (std::string(name) + "_mvs_full.ply")),
        {.noise_m = 0.1, .start_deg = 5, .start_m = 3}, 10, 15);
  return pairs;
}

}  // namespace scan::test
