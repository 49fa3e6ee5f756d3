// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Correspondences of one pair of clouds: nearest partners, the gates they pass, what the rest costs.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "libscan/align/icp.h"
#include "libscan/align/local_surface.h"
#include "libscan/align/residual.h"

namespace scan {

// The finite points of a cloud relative to their mean, so that far coordinates cost no digits.
struct LocalCloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;  // unit, (0,0,0) unknown; or empty
  double radius_m = 0;                   // root mean square distance from the mean
  std::size_t invalid_points = 0;
};

LocalCloud localise(const PointCloud& cloud);

// A pose between the clouds' own frames as one between their local frames, and back.
Pose local_pose(const Pose& target_from_source, const LocalCloud& source, const LocalCloud& target);
Pose global_pose(const Pose& local, const LocalCloud& source, const LocalCloud& target);

inline constexpr std::uint32_t no_partner = std::numeric_limits<std::uint32_t>::max();

// One per source point.
struct Match {
  std::uint32_t target = no_partner;
  double distance_m = 0;
  double residual_m = 0;  // size of what the method minimises
};

// A match farther than `distance_m` is none; a residual beyond `residual_m` counts as that much.
struct Gates {
  double distance_m = unlimited_m;
  double residual_m = unlimited_m;
};

// Both clouds must outlive it.
class PairFinder {
 public:
  PairFinder(const LocalCloud& source, const LocalCloud& target, const IcpOptions& options);

  std::vector<Match> find(const Pose& pose, double max_distance_m) const;

  // Gates that fit the matches at `pose`, never wider than `previous`. The distance is the given one,
  // or three times the median distance of those matches that are each other's nearest (what has no
  // counterpart pairs one-sidedly and so does not widen the gate), but not less than three times the
  // target's spacing. The residual leaves out the worst `trim_fraction`.
  Gates tightened(const Gates& previous, const Pose& pose, const std::vector<Match>& matches) const;

  // Source points whose matches pass both gates.
  std::vector<std::uint32_t> kept(const std::vector<Match>& matches, const Gates& gates) const;

  // Mean over all source points of the squared residual, cut at the gate, m^2; the objective.
  double cost_m2(const std::vector<Match>& matches, const Gates& gates) const;

  PointPair pair(const Pose& pose, const std::vector<Match>& matches, std::uint32_t i) const;
  LocalSurface& surface() { return target_surface_; }

 private:
  double mutual_median_m(const Pose& pose, const std::vector<Match>& matches) const;

  const LocalCloud& source_;
  const LocalCloud& target_;
  IcpOptions options_;
  AnySearch target_search_;
  KdTree source_search_;
  LocalSurface target_surface_;
};

}  // namespace scan
