// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Iterative closest point for one pair of clouds.
//
// All points of the source count at the end: no sample, however well chosen where a direction is
// weak, fixes any direction better than all of them weighed alike, and one chosen for stability
// (Gelfand et al. 2003) was measured to do as well in the weak one, no better.
//
// No parameter bears a unit: partners must lie within the reach of the target's local fits, and a
// Welsch loss whose scale follows the residuals, narrowing in steps (graduated non-convexity, Yang
// et al. 2020), settles which count. A rest rougher than the scans, or that points over the
// target's surface contradict, is sought anew, gates wider.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libscan/align/prepared_cloud.h"
#include "libscan/core/cost.h"

namespace scan {

enum class IcpMethod {
  point_to_point,  // Besl and McKay 1992, each step by singular value decomposition
  point_to_plane,  // Chen and Medioni 1992
  symmetric,       // Rusinkiewicz 2019: along the mean of both normals
  plane_to_plane,  // generalised ICP, Segal, Haehnel, Thrun 2009
};
std::string_view name_of(IcpMethod method);  // "point-to-point", "point-to-plane", ...
std::optional<IcpMethod> icp_method_from(std::string_view name);

// Why an alignment ended; only `converged` is success.
enum class Stop {
  converged,           // the step fell below the tolerances or its own uncertainty
  iteration_limit,     // still moving at max_iterations
  too_few_points,      // a cloud has fewer than 6 valid points; the pose is the guess
  no_correspondences,  // fewer than 6 pairs within the gates; the pose is the guess
  degenerate,          // converged in the directions that the data fix; others kept from the guess
  low_overlap,         // came to rest where fewer than min_overlap of the points have partners
};
std::string_view name_of(Stop stop);  // "converged", "iteration limit", "too few points", ...

struct IcpOptions {
  IcpMethod method = IcpMethod::symmetric;
  SearchMethod search = SearchMethod::kd_tree;  // of clouds that icp prepares itself
  double max_pair_distance_m = 0;               // 0: no limit but the reach of the local fits
  double max_normal_angle_rad = 0.785;          // between paired normals
  double trim_fraction = 0;                     // share of the worst pairs left out
  double min_overlap = 0.1;                     // of the smaller cloud's points
  int max_iterations = 60;
  double stop_rotation_rad = 1e-6;
  double stop_translation_fraction = 1e-6;  // of the source's extent
  // Called after each iteration with the current target_from_source.
  std::function<void(int iteration, const Pose&)> on_iteration = {};
};

// Throws scan::Error (usage) naming the option and its limit.
void check(const IcpOptions& options);

// Where an iteration began. Within one scale the objective never rises, but where all points take
// the place of the sample that a large source begins with. The last iteration ends where the
// gradient vanishes: partners jump as the pose moves, so that below the noise the objective is
// rough and where it is least depends on the start.
struct IcpState {
  double scale_m = 0;       // of the loss
  double objective_m2 = 0;  // mean loss over the points of the source
  double rms_m = 0;         // of the residuals, weighted
};

struct IcpResult {
  Pose target_from_source = Pose::Identity();
  Stop stop = Stop::too_few_points;
  int iterations = 0;
  std::size_t pairs = 0;  // that counted in the end
  double inlier_fraction_of_source = 0;
  double rms_m = 0;  // of their residual that was minimised
  // Of the overlap, in the target's frame, metres.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  // Inverse covariance of the pose as a twist about `centre` (rad, m): from the scatter of the
  // residuals and how far along the surface they go together. Zero along what the data leave open.
  Matrix6 information = Matrix6::Zero();
  // "slide along ...", "turn about ..." in the target frame.
  std::vector<std::string> weak_directions;
  std::vector<IcpState> history;   // of the descent that led here, its gates closed
  std::size_t invalid_points = 0;  // not finite, left out, both clouds together
  double guess_off_rotation = 0;  // Frobenius distance of the guess's matrix from the rotation used
  Cost cost;
};

// Both clouds stay as they are and may serve many calls at once.
IcpResult icp(const PreparedCloud& source, const PreparedCloud& target,
              const Pose& target_from_source_guess, const IcpOptions& options = {});

// Prepares both clouds, then as above.
IcpResult icp(const PointCloud& source, const PointCloud& target,
              const Pose& target_from_source_guess, const IcpOptions& options = {});

}  // namespace scan
