// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Removal of the free world frame by a rigid fit of all moved points, and what remains per scan.
#include "libscan/verify/pose_error.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <string>

#include "libscan/core/error.h"
#include "libscan/verify/statistics.h"

namespace scan {
namespace {

using PointLists = std::span<const std::vector<Eigen::Vector3d>>;

void check_input(std::span<const Pose> estimated, std::span<const Pose> truth, PointLists points) {
  if (estimated.size() != truth.size() || points.size() != truth.size() || truth.empty())
    throw Error(Trouble::input, "pose error: " + std::to_string(estimated.size()) +
                                    " estimated poses, " + std::to_string(truth.size()) +
                                    " true poses and " + std::to_string(points.size()) +
                                    " lists of points must be equally many, at least one");
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (points[i].empty())
      throw Error(Trouble::input, "pose error: scan " + std::to_string(i) + " has no points");
    if (!estimated[i].matrix().allFinite() || !truth[i].matrix().allFinite())
      throw Error(Trouble::input, "pose error: pose " + std::to_string(i) + " is not finite");
  }
}

Eigen::Vector3d centroid(const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d& origin = points.front();  // keeps digits far from the frame's origin
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& point : points) sum += point - origin;
  return origin + sum / static_cast<double>(points.size());
}

// Mean of the moved points over all scans, taken about the first one.
Eigen::Vector3d moved_centroid(std::span<const Pose> poses, PointLists points) {
  const Eigen::Vector3d origin = poses[0] * points[0].front();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto n = static_cast<double>(points[i].size());
    sum += n * (poses[i] * centroid(points[i]) - origin);
    count += n;
  }
  return origin + sum / count;
}

PoseError error_of(const Pose& estimated, const Pose& truth,
                   const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d c = centroid(points);
  double sum_m2 = 0;
  for (const auto& x : points) sum_m2 += (estimated * x - truth * x).squaredNorm();
  return {.rotation_rad = rotation_distance_rad(estimated, truth),
          .translation_m = (estimated * c - truth * c).norm(),
          .moved_points_rms_m = std::sqrt(sum_m2 / static_cast<double>(points.size()))};
}

}  // namespace

// Kabsch 1976: the rotation that maximises trace(R^T sum b a^T) of the centred pairs.
Pose gauge(std::span<const Pose> estimated, std::span<const Pose> truth, PointLists points) {
  check_input(estimated, truth, points);
  const Eigen::Vector3d mean_a = moved_centroid(estimated, points);
  const Eigen::Vector3d mean_b = moved_centroid(truth, points);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (const auto& x : points[i])
      covariance += (truth[i] * x - mean_b) * (estimated[i] * x - mean_a).transpose();
  const Eigen::Vector3d singular = Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
  if (!(singular(1) > 1e-12 * singular(0)))
    throw Error(
        Trouble::computation,
        "pose error: the points of all scans lie on one line, which leaves a rotation free");
  const Eigen::Matrix3d rotation = nearest_rotation(covariance);
  return make_pose(rotation, mean_b - rotation * mean_a);
}

std::vector<PoseError> pose_errors(std::span<const Pose> estimated, std::span<const Pose> truth,
                                   PointLists points) {
  const Pose true_from_estimated = gauge(estimated, truth, points);
  std::vector<PoseError> errors;
  for (std::size_t i = 0; i < truth.size(); ++i)
    errors.push_back(error_of(true_from_estimated * estimated[i], truth[i], points[i]));
  return errors;
}

std::vector<PoseError> relative_pose_errors(std::span<const Pose> estimated,
                                            std::span<const Pose> truth, PointLists points) {
  check_input(estimated, truth, points);
  std::vector<PoseError> errors;
  for (std::size_t i = 0; i + 1 < truth.size(); ++i)
    errors.push_back(error_of(estimated[i + 1].inverse() * estimated[i],
                              truth[i + 1].inverse() * truth[i], points[i]));
  return errors;
}

std::vector<Measurement> target_registration_error(
    std::span<const Pose> estimated, std::span<const Pose> truth, PointLists points,
    std::span<const Eigen::Vector3d> targets_in_world) {
  if (targets_in_world.empty()) throw Error(Trouble::input, "target registration: no target");
  const Pose true_from_estimated = gauge(estimated, truth, points);
  double worst_rms_m = 0, worst_m = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Pose moved = true_from_estimated * estimated[i] * truth[i].inverse();
    std::vector<double> errors_m;
    for (const auto& target : targets_in_world)
      errors_m.push_back((moved * target - target).norm());
    worst_rms_m = std::max(worst_rms_m, root_mean_square(errors_m));
    worst_m = std::max(worst_m, quantile(errors_m, 1));
  }
  const auto figure = [&](const char* name, double value) {
    return Measurement{.name = name,
                       .value = value,
                       .unit = "m",
                       .over = std::to_string(targets_in_world.size()) +
                               " targets, largest over the scans, world frame fitted",
                       .count = truth.size()};
  };
  return {figure("target_registration_error", worst_rms_m),
          figure("target_registration_error_max", worst_m)};
}

std::vector<Measurement> summarise_relative(const std::vector<PoseError>& errors) {
  if (errors.empty()) return {};
  std::vector<double> rotations_rad, translations_m;
  for (const PoseError& error : errors) {
    rotations_rad.push_back(error.rotation_rad);
    translations_m.push_back(error.translation_m);
  }
  const auto figure = [&](const char* name, double value, const char* unit, const char* over) {
    return Measurement{
        .name = name, .value = value, .unit = unit, .over = over, .count = errors.size()};
  };
  const char* largest = "largest over pairs of neighbouring scans";
  const char* average = "mean over pairs of neighbouring scans";
  return {figure("relative_rotation_error", quantile(rotations_rad, 1), "rad", largest),
          figure("relative_translation_error", quantile(translations_m, 1), "m", largest),
          figure("relative_rotation_error_mean", mean(rotations_rad), "rad", average),
          figure("relative_translation_error_mean", mean(translations_m), "m", average)};
}

std::vector<Measurement> summarise(const std::vector<PoseError>& errors) {
  std::vector<double> rotations_rad, translations_m, points_rms_m;
  for (const PoseError& error : errors) {
    rotations_rad.push_back(error.rotation_rad);
    translations_m.push_back(error.translation_m);
    points_rms_m.push_back(error.moved_points_rms_m);
  }
  const auto figure = [&](const char* name, double value, const char* unit, const char* over) {
    return Measurement{
        .name = name, .value = value, .unit = unit, .over = over, .count = errors.size()};
  };
  const char* largest = "largest over the scans, world frame fitted";
  const char* average = "mean over the scans, world frame fitted";
  return {figure("rotation_error", quantile(rotations_rad, 1), "rad", largest),
          figure("translation_error", quantile(translations_m, 1), "m", largest),
          figure("pose_error_rms", quantile(points_rms_m, 1), "m", largest),
          figure("rotation_error_mean", mean(rotations_rad), "rad", average),
          figure("translation_error_mean", mean(translations_m), "m", average),
          figure("pose_error_rms_mean", mean(points_rms_m), "m", average)};
}

}  // namespace scan
