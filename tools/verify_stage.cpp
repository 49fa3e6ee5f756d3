// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/verify_stage.h"

#include "libscan/core/error.h"
#include "libscan/reconstruct/surface_result.h"
#include "libscan/verify/pose_error.h"
#include "libscan/verify/self_intersection.h"
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

std::vector<Measurement> measure_poses(const RunResult& result, const Truth& truth) {
  const std::vector<Pose> should = true_poses(truth);
  const std::span<const Pose> is = result.world_from_scan;
  const auto felt = picked_points(result.scans);
  const Bounds box = bounds_of(truth.surface);
  auto figures = summarise(run_pose_errors(result, truth));
  add(figures, summarise_relative(relative_pose_errors(is, should, felt)));
  add(figures,
      target_registration_error(
          is, should, felt,
          corners_of(box.sizes().allFinite() ? box
                                             : bounds_of(in_true_world(result, truth).vertices))));
  if (!result.stated_poses.scans.empty())
    add(figures,
        stated_uncertainty(
            "pose", normalised_pose_errors(is, should, result.stated_poses.scans, result.anchor),
            "scans with a covariance, relative to the anchor"));
  return figures;
}

// Every ray's true end, world frame.
std::vector<Eigen::Vector3d> true_hits(const Truth& truth) {
  std::vector<Eigen::Vector3d> hits;
  for (const ScanTruth& scan : truth.scans)
    for (const RayTruth& ray : scan.rays)
      if (ray.object >= 0) hits.push_back(scan.world_from_scanner * ray.point_in_scanner);
  return hits;
}

void check_scans(const RunResult& result, const Truth& truth) {
  const std::size_t scans = result.scans.size();
  if (truth.scans.size() != scans || result.world_from_scan.size() != scans)
    throw Error(Trouble::input, "run: has " + std::to_string(scans) + " scans, " +
                                    std::to_string(result.world_from_scan.size()) +
                                    " poses and the truth of " +
                                    std::to_string(truth.scans.size()) +
                                    "; they must be equally many (was it cut short?)");
}

}  // namespace

void add(std::vector<Measurement>& to, std::vector<Measurement> more) {
  for (Measurement& measurement : more) to.push_back(std::move(measurement));
}

std::vector<Eigen::Vector3d> corners_of(const Bounds& box) {
  std::vector<Eigen::Vector3d> corners;
  for (int corner = 0; corner < 8; ++corner)
    corners.push_back(box.corner(static_cast<Bounds::CornerType>(corner)));
  return corners;
}

std::vector<Measurement> measure_shape(const SupportedMesh& surface, const TrueSurface& truth,
                                       const Pose& by_anchor) {
  std::vector<Measurement> figures = size_error(surface.mesh, truth);
  add(figures, topology(surface.mesh));
  if (auto crossings = self_intersection(surface.mesh)) figures.push_back(std::move(*crossings));
  if (surface.support_m.empty() || surface.data_spacing_m.empty()) return figures;
  std::vector<double> spacings;
  for (std::size_t i = 0; i < surface.support_m.size(); ++i)
    spacings.push_back(surface.support_m[i] / surface.data_spacing_m[i]);
  figures.push_back(unsupported_area(surface.mesh, spacings, supported_within_spacings));
  if (surface.standard_error_m.empty()) return figures;
  const Mesh moved = transformed(by_anchor, surface.mesh);
  add(figures,
      stated_uncertainty(
          "surface",
          normalised_deviations(deviations_m(moved.vertices, truth), surface.standard_error_m,
                                spacings, supported_within_spacings),
          "supported vertices with a standard error, the anchor's pose held right"));
  return figures;
}

std::vector<PoseError> run_pose_errors(const RunResult& result, const Truth& truth) {
  return pose_errors(result.world_from_scan, true_poses(truth), picked_points(result.scans));
}

Pose true_world_from_world(const RunResult& result, const Truth& truth) {
  return gauge(result.world_from_scan, true_poses(truth), picked_points(result.scans));
}

Mesh in_true_world(const RunResult& result, const Truth& truth) {
  return transformed(true_world_from_world(result, truth), result.surface.mesh);
}

std::vector<Measurement> measure_run(const RunResult& result, const Truth& truth,
                                     const VerifySettings& settings) {
  check_scans(result, truth);
  SupportedMesh surface = result.surface;
  surface.mesh = in_true_world(result, truth);
  const std::vector<Eigen::Vector3d> seen = true_hits(truth);
  SurfaceErrorOptions options{.samples = static_cast<std::size_t>(settings.samples),
                              .f_score_threshold_m = settings.f_score_threshold_m};
  if (settings.seen_distance_m > 0) {
    options.seen_points = seen;
    options.seen_distance_m = settings.seen_distance_m;
  }
  std::vector<Measurement> measurements = surface_error(surface.mesh, truth.surface, options);
  // Poses that were not estimated are what they are.
  const std::vector<Pose> should = true_poses(truth);
  const Pose by_anchor = result.stated_poses.scans.empty()
                             ? Pose::Identity()
                             : should[result.anchor] *
                                   result.world_from_scan[result.anchor].inverse() *
                                   true_world_from_world(result, truth).inverse();
  add(measurements, measure_shape(surface, truth.surface, by_anchor));
  add(measurements, measure_poses(result, truth));
  add(measurements, measure_ranges(result.scans, truth));
  return measurements;
}

}  // namespace scan
