// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Points to surface, as `scan reconstruct` and `scan run` do it.
#pragma once

#include "libscan/io/surface_file.h"
#include "libscan/reconstruct/surface_uncertainty.h"
#include "tools/console.h"
#include "tools/recipe.h"

namespace scan {

// Leaves out points with too large a sigma, thins, reconstructs, trims and decimates. The cloud is
// in the world frame; `viewpoints` holds where the scanner of each point stood, or is empty;
// `common` is what its points' errors share.
SurfaceResult make_surface(PointCloud cloud, std::vector<Eigen::Vector3d> viewpoints,
                           CommonErrors common, const ReconstructSettings& settings,
                           Console& console);

// The surface with what its vertices know, as it is written.
SupportedMesh supported(const SurfaceResult& result);

}  // namespace scan
