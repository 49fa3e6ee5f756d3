// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Correspondences of one pair of clouds: nearest partners, the gates they pass, what the rest
// costs.
#pragma once

#include <span>
#include <vector>

#include "libscan/align/icp.h"
#include "libscan/align/loss.h"
#include "libscan/align/residual.h"

namespace scan {

// Of the reach of a local fit, within which its plane stands for the surface. At the rim of a scan
// all neighbours lie to one side, and beyond it the plane leaves a curved surface by the square of
// the distance: all pairs along a rim alike, which no scatter tells.
inline constexpr double plane_share_of_reach = 0.5;

// The partner of a source point, and how far off it is.
struct Match {
  std::uint32_t target = no_point;  // nearest, also where it passes no gate: the next guess
  // Where the source point was when its nearest was last searched for, and how far off at least all
  // others were: while it has moved less than they are farther, no search is needed.
  float others_m = 0;
  Eigen::Vector3f searched_at = Eigen::Vector3f::Zero();
  double residual_m = unlimited_m;  // size of what the method minimises; unlimited: no pair
};

// Two points that count.
struct Couple {
  std::uint32_t source = 0, target = 0;
  double residual_m = 0;
};

// What counts, and how much: the loss of a residual, up to the limit.
struct Weighing {
  WelschLoss loss;
  double limit_m = unlimited_m;
};

// All poses are local ones (prepared_cloud.h). Both clouds must outlive it.
class PairFinder {
 public:
  PairFinder(const PreparedCloud& source, const PreparedCloud& target, const IcpOptions& options);

  // Writes matches[k], the partner of source point sample[k] at `pose`. What was there before, if
  // anything, is taken for a guess. A pair lies within the options' distance and angle of normals,
  // where both are known, and along the target's surface within the reach of its local fit, of a
  // plane within its share: beyond the rim of a scan the nearest point is one of the rim, which
  // says nothing.
  void find(const Pose& pose, std::span<const std::uint32_t> sample,
            std::vector<Match>& matches) const;

  // From now on `find` takes every pair that lies within the distance, of normals towards one side
  // where their signs mean something, and beyond it what the gates let pass. 0: these alone.
  void open_gates(double within_m) { open_m_ = within_m; }

  // Median residual of the pairs, metres; 0 for none.
  double median_residual_m(std::span<const Match> matches) const;

  // How much of a small motion across the surface shows in the residuals: less than all, since
  // among noisy points the nearest are those that did not seem to move. Between 0.1 and 1.
  double shown_share(const Pose& pose, std::span<const Couple> couples,
                     const WelschLoss& loss) const;

  // Mean loss over the sample, m^2; what is no pair costs as much as the farthest.
  double objective_m2(std::span<const Match> matches, const Weighing& weighing) const;

  // The pairs that the loss lets count.
  std::vector<Couple> kept(std::span<const std::uint32_t> sample, std::span<const Match> matches,
                           const Weighing& weighing) const;

  // The points and normals of a pair, the normals on one side.
  PointPair pair(const Pose& pose, const Couple& couple) const;

  // Of moved - target, as plane-to-plane has it: r^2 = d^T W d, metres^2.
  Eigen::Matrix3d metric(const Pose& pose, const Couple& couple) const;

  const PreparedCloud& source() const { return source_; }
  const PreparedCloud& target() const { return target_; }
  IcpMethod method() const { return options_.method; }

 private:
  double residual_m(const Pose& pose, const Couple& couple) const;
  Eigen::Matrix3d covariance_m2(const PreparedCloud& cloud, std::uint32_t i) const;

  const PreparedCloud& source_;
  const PreparedCloud& target_;
  const IcpOptions& options_;
  double open_m_ = 0;    // see open_gates
  double spread_m_ = 0;  // along the surfaces, see metric
  double noise_m_ = 0;   // across them
};

}  // namespace scan
