// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A run's truth on disk: truth/poses.tum, truth/surface.json or surface.ply, truth/NNN.ply.
#pragma once

#include <filesystem>

#include "libscan/verify/truth.h"

namespace scan {

void write_truth(const std::filesystem::path& folder, const Truth& truth);
Truth read_truth(const std::filesystem::path& folder);

// A reference surface by file: a mesh (any format of read_mesh) or surface.json with analytic shapes.
TrueSurface read_true_surface(const std::filesystem::path& path);

}  // namespace scan
