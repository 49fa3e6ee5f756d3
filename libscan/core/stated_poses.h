// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What an alignment states of its poses' errors.
#pragma once

#include <optional>
#include <vector>

#include "libscan/core/pose.h"

namespace scan {

// The covariance of a turn (rad) about `centre` and a shift (m), along the world's axes.
struct StatedPose {
  Matrix6 covariance = Matrix6::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // world
};

// Of the motions of two scans, those of the first along the rows: what moves one by noise may move
// the other by the same noise.
struct CommonCovariance {
  std::size_t first = 0, second = 0;  // first < second
  Matrix6 covariance = Matrix6::Zero();
};

struct StatedPoses {
  std::vector<std::optional<StatedPose>> scans;  // none: a motion is not known
  std::vector<CommonCovariance> between;         // of scans that see the same, by first and second
};

}  // namespace scan
