// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pairs of clouds made from real scans whose true motion is known, or that have none.
//
// A split pair: the points of one scan shared out at random into halves that have none in common,
// each half cut at a plane so that the wanted share of its points is left to both, one of them
// moved by a random motion (any rotation). Pairs without overlap: different things brought to the
// same extent, so that size does not give them away.
#pragma once

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>

#include "libscan/acquire/normals.h"
#include "libscan/align/features.h"
#include "libscan/core/random.h"
#include "libscan/io/image_file.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"

namespace scan::test {

struct RealCloud {
  std::string name, thing;
  PointCloud cloud;
  std::optional<Eigen::Vector3d> viewpoint;
};

struct RealPair {
  RealCloud source, target;
  Pose target_from_source = Pose::Identity();
};

inline RealCloud read_cloud(const std::filesystem::path& path, const std::string& thing,
                            bool one_viewpoint) {
  Scan scan = read_scan(path);
  if (scan.cloud.normals.empty()) estimate_normals(scan);
  RealCloud real{path.stem().string(), thing, scan.cloud, std::nullopt};
  if (one_viewpoint) real.viewpoint = scan.viewpoint;
  return real;
}

// A depth frame in millimetres of a camera with 525 px focal length, every second pixel.
inline RealCloud read_depth_frame(const std::filesystem::path& path) {
  const Image<std::uint16_t> depth = read_grey16(path);
  Scan scan;
  scan.grid = {std::uint32_t(depth.height / 2), std::uint32_t(depth.width / 2)};
  for (std::uint32_t row = 0; row < scan.grid.rows; ++row)
    for (std::uint32_t column = 0; column < scan.grid.columns; ++column) {
      const int u = int(column) * 2, v = int(row) * 2;
      const double z_m = 1e-3 * depth(u, v);
      if (z_m == 0) continue;
      scan.cloud.points.emplace_back(z_m * (u - 319.5) / 525, z_m * (v - 239.5) / 525, z_m);
      scan.ray.push_back(row * scan.grid.columns + column);
    }
  estimate_normals(scan);
  return {"frame " + path.stem().string(), "room", scan.cloud, scan.viewpoint};
}

// The bunny's scans are named so, in the order of bun.conf.
inline std::vector<RealCloud> bunny_scans(const std::filesystem::path& data) {
  std::vector<RealCloud> scans;
  const std::filesystem::path folder = data / "stanford-bunny/data";
  for (const NamedPose& pose : read_poses(folder / "bun.conf"))
    scans.push_back(read_cloud(folder / pose.name, "bunny", true));
  return scans;
}

inline std::vector<RealCloud> other_clouds(const std::filesystem::path& data) {
  const std::filesystem::path mvs = data / "reconbench/scan_ply/with_normals";
  const std::filesystem::path lidar = data / "lidar-small_gicp", frames = data / "redwood-rgbd";
  return {read_cloud(mvs / "anchor_mvs.ply", "anchor", false),
          read_cloud(mvs / "lordquas_mvs.ply", "lordquas", false),
          read_cloud(lidar / "source.ply", "street", true),
          read_cloud(lidar / "target.ply", "street", true),
          read_depth_frame(frames / "depth/00000.png"),
          read_depth_frame(frames / "depth/00004.png")};
}

inline double extent_m(const RealCloud& real) {
  return bounds_of(real.cloud.points).diagonal().norm();
}

inline Eigen::Vector3d normal_vector(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

inline Pose any_motion(RandomStream& random, double shift_m) {
  const Eigen::Vector3d axis = normal_vector(random).normalized();
  const double angle = std::numbers::pi * random.uniform();
  const Eigen::Vector3d shift = shift_m * normal_vector(random);
  return make_pose(Eigen::AngleAxisd(angle, axis).toRotationMatrix(), shift);
}

inline RealCloud moved(const Pose& pose, RealCloud real) {
  real.cloud = transformed(pose, real.cloud);
  if (real.viewpoint) real.viewpoint = pose * *real.viewpoint;
  return real;
}

inline RealPair split_pair(const RealCloud& real, double overlap, std::uint64_t seed) {
  RandomStream random(seed, 1, 0);
  const Eigen::Vector3d across = normal_vector(random).normalized();
  std::vector<double> at;
  for (const Eigen::Vector3d& x : real.cloud.points) at.push_back(across.dot(x));
  std::vector<double> ordered = at;
  std::sort(ordered.begin(), ordered.end());
  // Each keeps the share k = 1 / (2 - overlap) of its half; both have 2 k - 1 = overlap * k.
  const double share = 1 / (2 - overlap), last = double(ordered.size() - 1);
  const double upper = ordered[std::size_t(last * share)];
  const double lower = ordered[std::size_t(last * (1 - share))];
  std::vector<std::uint32_t> below, above;
  for (std::uint32_t i = 0; i < at.size(); ++i) {
    const bool first = random.uniform() < 0.5;
    if (first && at[i] <= upper) below.push_back(i);
    if (!first && at[i] >= lower) above.push_back(i);
  }
  RealPair pair{real, real, Pose::Identity()};
  pair.source.cloud = subset(real.cloud, below);
  pair.target.cloud = subset(real.cloud, above);
  const Pose motion = any_motion(random, extent_m(real));
  pair.source = moved(motion, pair.source);
  pair.target_from_source = motion.inverse();
  return pair;
}

// `a` brought to the extent of `b` and moved at random.
inline RealPair unrelated_pair(RealCloud a, const RealCloud& b, std::uint64_t seed) {
  RandomStream random(seed, 2, 0);
  const double factor = extent_m(b) / extent_m(a);
  for (Eigen::Vector3d& x : a.cloud.points) x *= factor;
  if (a.viewpoint) *a.viewpoint *= factor;
  const Pose motion = any_motion(random, extent_m(b));
  return {moved(motion, a), b, Pose::Identity()};
}

struct PairFeatures {
  ScanFeatures source, target;
};

inline PairFeatures describe_pair(const RealPair& pair) {
  const std::vector<PointCloud> both = {pair.source.cloud, pair.target.cloud};
  const double side_m = feature_side_m(both);
  return {describe(pair.source.cloud, side_m, pair.source.viewpoint),
          describe(pair.target.cloud, side_m, pair.target.viewpoint)};
}

// Root mean square distance between where two poses put the cloud's points, in sides of the cubes.
inline double sides_apart(const ScanFeatures& features, const Pose& a, const Pose& b) {
  double sum2 = 0;
  for (const Eigen::Vector3d& x : features.cloud.points) sum2 += (a * x - b * x).squaredNorm();
  return std::sqrt(sum2 / double(features.cloud.size())) / features.side_m;
}

}  // namespace scan::test
