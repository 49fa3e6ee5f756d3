// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A surface in the unit cube, carried back to where the points are.
#pragma once

#include "libscan/reconstruct/samples.h"
#include "libscan/reconstruct/surface_result.h"

namespace scan {

// Without the components next to less than 0.1 % of the data; with each vertex' support and the
// samples' counts. Throws scan::Error (computation), naming the method, for an empty mesh.
SurfaceResult world_surface(Mesh in_unit_cube, const Samples& samples, const char* method);

}  // namespace scan
