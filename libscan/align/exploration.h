// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Poses proposed without descriptors, for surfaces that have no features: all rotations are tried.
#pragma once

#include <vector>

#include "libscan/align/features.h"
#include "libscan/core/pose.h"

namespace scan {

// For each rotation of a grid the translations that most pairs of points with like normals ask for,
// ranked by how many points then lie near the other surface: the best `most`.
std::vector<Pose> explore_rotations(const ScanFeatures& source, const ScanFeatures& target,
                                    std::size_t most);

}  // namespace scan
