// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How well a pose of two scans stands before their surfaces: how much of them meets, how much
// should and does not, and what one scanner would have seen through the other's surface.
#pragma once

#include <memory>
#include <vector>

#include "libscan/align/features.h"
#include "libscan/core/pose.h"

namespace scan {

struct PoseVerdict {
  double overlap = 0;   // share of the smaller cloud's points that lie on the other's surface
  double conflict = 0;  // share of the points that meet or contradict which contradict
  double rms_m = 0;     // point to plane, of the points that meet
  // 0 to 1: (1 - conflict) times by how much the points that meet lie closer to the other's planes
  // than chance would put them: 1 - variance / variance of a uniform distribution within the
  // tolerance. Little that meets counts for less.
  double trust = 0;
};

// Both features must outlive it.
class PoseJudge {
 public:
  PoseJudge(const ScanFeatures& source, const ScanFeatures& target);
  ~PoseJudge();

  // The pose moved to where the surfaces lie on each other, by point-to-plane pairs whose reach
  // shrinks from three sides of the cubes to one.
  Pose settled(const Pose& target_from_source) const;

  PoseVerdict judge(const Pose& target_from_source) const;

  // The pose moved to and fro along the three motions that the surfaces resist least, so that the
  // points that meet move by `distance_m` (root mean square). One that then settles elsewhere, and
  // as well, was free to slide.
  std::vector<Pose> slid(const Pose& target_from_source, double distance_m) const;

  // How far from the other's plane a point may be and still lie on it.
  double tolerance_m() const;

  // By how much, of each metre that the points move (root mean square) along the motion that the
  // surfaces resist least, they leave the other's planes: 0 for a free motion, at most 1.
  double least_resistance(const Pose& target_from_source) const;

 private:
  struct Side;
  struct Pairs;
  Pairs pairs(const Pose& pose, double reach_m, const Eigen::Vector3d& centre) const;
  std::unique_ptr<Side> source_, target_;
};

}  // namespace scan
