// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Surface normals from neighbouring points, oriented towards the scanner.
#pragma once

#include "libscan/core/scan.h"

namespace scan {

struct NormalOptions {
  int neighbours = 16;
};

// Fills scan.cloud.normals by plane fits over the nearest points (weighted by sigma where known)
// and turns each towards scan.viewpoint. With a grid the nearest are those of a square of
// rays without a jump in depth, else the nearest in space. A neighbourhood that fixes no plane is
// widened twice, then gives (0, 0, 0).
// For a scan whose viewpoint moves (laser line, moving lidar) `viewpoints` has one per point;
// empty: scan.viewpoint for all.
void estimate_normals(Scan& scan, const NormalOptions& options = {},
                      std::span<const Eigen::Vector3d> viewpoints = {});

}  // namespace scan
