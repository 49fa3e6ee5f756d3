// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the methods share whose vertices are the points themselves.
#pragma once

#include <functional>
#include <span>

#include "libscan/reconstruct/surface_result.h"

namespace scan {

// Triangles over points, in their order.
using Triangulate = std::function<Mesh(std::span<const Eigen::Vector3d> points)>;

// Over the finite points; each component is turned so that most of its area agrees with its
// vertices' normals, if there are any. `method` is how errors call it: input for fewer than 4
// finite points, computation if no triangle comes.
SurfaceResult interpolating_surface(const PointCloud& cloud, const Triangulate& triangulate,
                                    const char* method);

}  // namespace scan
