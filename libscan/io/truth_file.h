// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A run's truth on disk: poses.tum, surface.json, NNN.ply.
//
// surface.json: { "shapes": [ { "shape": {...}, "parent_from_shape": 4x4 } ], "meshes": ["FILE",
// ...] }, mesh files beside it. NNN.ply: per ray x y z nx ny nz object, scanner frame, NaN where
// the ray meets nothing (object -1).
#pragma once

#include <filesystem>

#include "libscan/verify/truth.h"

namespace scan {

// Into an existing folder, a scan at a time and the rest, in any order. All doubles come back to
// the bit but the rotations, which go through a quaternion (2e-15 rad). Scans are named by their
// number: "000", "001", ...
void write_true_rays(const std::filesystem::path& folder, std::size_t scan,
                     const std::vector<RayTruth>& rays);
void write_true_scene(const std::filesystem::path& folder, const TrueSurface& surface,
                      const std::vector<Pose>& world_from_scanner);
Truth read_truth(const std::filesystem::path& folder);

// A reference surface by file; scan::Error (input) if it is empty. A mesh (any format of read_mesh)
// or surface.json with analytic shapes.
TrueSurface read_true_surface(const std::filesystem::path& path);

}  // namespace scan
