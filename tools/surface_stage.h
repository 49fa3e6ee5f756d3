// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Points to surface, as `scan reconstruct` and `scan run` do it.
#pragma once

#include "libscan/reconstruct/surface_result.h"
#include "tools/console.h"
#include "tools/recipe.h"

namespace scan {

// Leaves out points with too large a sigma, thins, reconstructs and trims. The cloud is in the
// world frame and has normals.
SurfaceResult make_surface(PointCloud cloud, const ReconstructSettings& settings, Console& console);

std::string_view name_of(ReconstructMethod method);

}  // namespace scan
