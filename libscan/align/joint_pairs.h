// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Correspondences between many scans at given poses, compressed to one quadratic form per couple of
// scans (Pulli 1999), so that the solver's work does not grow with the points.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "libscan/align/icp.h"
#include "libscan/align/observability.h"

namespace scan {

// Partners in `target` for points of `source`: for every `stride`-th from `first` on.
struct JointCouple {
  std::size_t source = 0, target = 0;
  std::size_t stride = 1, first = 0;
  double scale_m = unlimited_m;  // of the loss in the last round
  double first_m = 0;            // least of the first round's
};

// What the pairs in one place pull the pose with.
struct PatchPull {
  std::array<std::int64_t, 3> place;
  Vector6 gradient = Vector6::Zero();
};

// The sum of the pairs' losses over the squared sigma of their residuals, as w (r + J x)^2 with x =
// twist of `source` minus twist of `target`: to first order only the difference of the poses
// matters. Twists are about the frame's centre along the world's axes, translations in units of its
// size.
struct JointForm {
  std::size_t source = 0, target = 0;
  std::size_t asked = 0;  // points of the source
  std::size_t pairs = 0;
  DataFrame frame;
  double scale_m = 0;      // of the loss
  bool narrowing = false;  // it is still wider than the residuals ask for
  double rms_m = 0;        // of the residuals, weighted
  Matrix6 a = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
  Matrix6 apparent = Matrix6::Zero();  // what the planes seem to fix (observability.h), and
  Matrix6 noise = Matrix6::Zero();     // what of it the errors of their normals feign
};

// What the covariance takes more.
struct JointDetail {
  // Mean second derivative, free of the normals' noise and of what the partners' choice hides.
  Matrix6 curvature = Matrix6::Zero();
  std::vector<PatchPull> pulls;       // by place
  std::vector<std::uint32_t> paired;  // points of the source that have a partner
};

// Both directions of every pair of scans, each point asked in up to `most_partners` others.
std::vector<JointCouple> joint_couples(
    std::span<const std::pair<std::size_t, std::size_t>> overlapping, std::size_t scans,
    std::size_t most_partners);

// The form of a couple; none if fewer than options.min_overlap of the asked points count. The scale
// is that of the residuals, at first no narrower than `first_m`, then never wider than the couple's
// last one and never narrower than 0.7 of it: what a narrower one leaves out may be what was to
// pull. Points of `target_rim` (rims.h) are no partners: beyond a scan's end the nearest are those
// that noise along diverging rays has carried outwards, which are the far ones. That bends scan
// after scan the same way.
JointForm joint_form(const JointCouple& couple, const PreparedCloud& source,
                     const PreparedCloud& target, const Pose& world_from_source,
                     const Pose& world_from_target, const IcpOptions& options, double patch_m = 0,
                     JointDetail* detail = nullptr, const std::vector<bool>& target_rim = {});

}  // namespace scan
