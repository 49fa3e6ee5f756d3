// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/verify_stage.h"

#include "libscan/verify/pose_error.h"
#include "libscan/verify/size_error.h"
#include "libscan/verify/surface_error.h"

namespace scan {
namespace {

constexpr std::size_t points_per_pose_error = 2000;

std::vector<Pose> true_poses(const Truth& truth) {
  std::vector<Pose> poses;
  for (const ScanTruth& scan : truth.scans) poses.push_back(scan.world_from_scanner);
  return poses;
}

// Evenly picked points of each scan, enough to feel a pose's error.
std::vector<std::vector<Eigen::Vector3d>> picked_points(const std::vector<Scan>& scans) {
  std::vector<std::vector<Eigen::Vector3d>> picked;
  for (const Scan& scan : scans) {
    const std::size_t step = std::max<std::size_t>(1, scan.cloud.size() / points_per_pose_error);
    auto& points = picked.emplace_back();
    for (std::size_t i = 0; i < scan.cloud.size(); i += step)
      points.push_back(scan.cloud.points[i]);
  }
  return picked;
}

// All scans as one, their rays numbered one after the other.
std::vector<Measurement> measure_ranges(const std::vector<Scan>& scans, const Truth& truth) {
  PointCloud cloud;
  std::vector<std::uint32_t> rays;
  ScanTruth all{.name = "all scans"};
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(all.rays.size());
    for (const std::uint32_t ray : scans[i].ray) rays.push_back(first + ray);
    if (i == 0)
      cloud = scans[i].cloud;
    else
      append(cloud, scans[i].cloud);
    all.rays.insert(all.rays.end(), truth.scans[i].rays.begin(), truth.scans[i].rays.end());
  }
  return range_error(cloud, rays, all);
}

void add(std::vector<Measurement>& to, std::vector<Measurement> more) {
  for (Measurement& measurement : more) to.push_back(std::move(measurement));
}

}  // namespace

Pose true_world_from_world(const RunResult& result, const Truth& truth) {
  return gauge(result.world_from_scan, true_poses(truth), picked_points(result.scans));
}

Mesh in_true_world(const RunResult& result, const Truth& truth) {
  return transformed(true_world_from_world(result, truth), result.surface);
}

std::vector<Measurement> measure_run(const RunResult& result, const Truth& truth,
                                     const VerifySettings& settings) {
  const Mesh surface = in_true_world(result, truth);
  std::vector<Eigen::Vector3d> seen;
  for (const ScanTruth& scan : truth.scans)
    for (const RayTruth& ray : scan.rays)
      if (ray.object >= 0) seen.push_back(scan.world_from_scanner * ray.point_in_scanner);
  SurfaceErrorOptions options{.samples = static_cast<std::size_t>(settings.samples),
                              .f_score_threshold_m = settings.f_score_threshold_m};
  if (settings.seen_distance_m > 0) {
    options.seen_points = seen;
    options.seen_distance_m = settings.seen_distance_m;
  }
  std::vector<Measurement> measurements = surface_error(surface, truth.surface, options);
  add(measurements, size_error(surface, truth.surface));
  add(measurements, topology(surface));
  const auto felt = picked_points(result.scans);
  add(measurements, summarise(pose_errors(result.world_from_scan, true_poses(truth), felt)));
  add(measurements,
      summarise_relative(relative_pose_errors(result.world_from_scan, true_poses(truth), felt)));
  add(measurements, measure_ranges(result.scans, truth));
  return measurements;
}

}  // namespace scan
