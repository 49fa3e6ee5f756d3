// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Iterative closest point for one pair of clouds.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libscan/core/cost.h"
#include "libscan/core/point_cloud.h"
#include "libscan/search/search.h"

namespace scan {

enum class IcpMethod { point_to_point, point_to_plane };
std::string_view name_of(IcpMethod method);  // "point-to-point", "point-to-plane"
std::optional<IcpMethod> icp_method_from(std::string_view name);

// Why an alignment ended; only `converged` is success.
enum class Stop {
  converged,           // the step fell below both tolerances
  iteration_limit,     // still moving at max_iterations
  too_few_points,      // a cloud has fewer than 6 valid points; the pose is the guess
  no_correspondences,  // fewer than 6 pairs within the gates; the pose is the guess
  degenerate,          // converged in the directions that the data fix; others kept from the guess
};
std::string_view name_of(Stop stop);  // "converged", "iteration limit", "too few points", ...

struct IcpOptions {
  IcpMethod method = IcpMethod::point_to_plane;
  SearchMethod search = SearchMethod::kd_tree;
  double max_pair_distance_m = 0;       // 0: three times the median pair distance, shrinking
  double max_normal_angle_rad = 0.785;  // between paired normals, where both clouds have them
  double trim_fraction = 0.1;           // share of the worst pairs left out
  int max_iterations = 60;
  double stop_rotation_rad = 1e-6;
  double stop_translation_fraction = 1e-6;  // of the source's extent
  // Called after each iteration with the current target_from_source.
  std::function<void(int iteration, const Pose&)> on_iteration = {};
};

// Throws scan::Error (usage) naming the option and its limit.
void check(const IcpOptions& options);

struct IcpResult {
  Pose target_from_source = Pose::Identity();
  Stop stop = Stop::too_few_points;
  int iterations = 0;
  std::size_t pairs = 0;
  double inlier_fraction_of_source = 0;
  double rms_m = 0;  // of the residual that was minimised, over the pairs kept
  Matrix6 information =
      Matrix6::Zero();  // J^T J / sigma^2 at the end, about the target's frame origin
  std::vector<std::string>
      weak_directions;  // "slide along ...", "turn about ..." in the target frame
  std::vector<double> history_rms_m;
  std::size_t invalid_points = 0;  // not finite, left out, both clouds together
  double guess_off_rotation = 0;  // Frobenius distance of the guess's matrix from the rotation used
  Cost cost;
};

// Point-to-plane needs target normals: zero ones are not used, missing ones are scan::Error
// (input).
IcpResult icp(const PointCloud& source, const PointCloud& target,
              const Pose& target_from_source_guess, const IcpOptions& options = {});

}  // namespace scan
