// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the edges of a pose graph must be, and how strongly one holds.
#pragma once

#include "libscan/align/pose_graph.h"

namespace scan {

// Throws scan::Error (input) for an anchor or edges that name no scan, and edges that are not
// finite.
void check(std::span<const PoseEdge> edges, std::size_t scans, std::size_t anchor);

// S with S^T S = information, rows of open motions zero.
Matrix6 root_of(const Matrix6& information);

}  // namespace scan
