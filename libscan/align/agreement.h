// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How well scans lie on each other where they meet, measured by what each scan's own noise allows.
//
// An alignment that ended in a wrong minimum still has a small step and, among the pairs that its
// gates keep, small residuals. It shows in the points that should have partners and miss them.
// Right poses of one object's scans reach 0.9; of outdoor scans, whose views share little of what
// they see within the reach, 0.2: the figure ranks poses of one pair, no threshold tells right from
// wrong.
#pragma once

#include <span>

#include "libscan/align/prepared_cloud.h"

namespace scan {

// Residuals up to this many metres are the scan's own doing: three times the `sigma_m` that the
// device tells (0: it does not), or three sigma of what its points differ from the plane of their
// nearest neighbour (noise, curvature and sampling together), but not less than a quarter of its
// spacing.
double tolerated_residual_m(const PreparedCloud& cloud, double sigma_m);

// A scan, which outlives it, at a pose of its prepared points.
struct PosedScan {
  const PreparedCloud* cloud = nullptr;
  Pose world_from_local = Pose::Identity();
  double tolerance_m = 0;
};

struct Agreement {
  double expected = 0;  // share of the scan's points near another scan
  double agreeing = 0;  // share of them within tolerance of the nearest one's plane; 0 for none
};

// `reach_m`: points so near to another scan, and with a normal less than 60 degrees off, count as
// seen by both. From up to 1024 points.
Agreement agreement(const PosedScan& scan, std::span<const PosedScan> others, double reach_m);

}  // namespace scan
