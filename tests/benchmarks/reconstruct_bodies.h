// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The true surfaces that reconstruction methods are compared on.
#pragma once

#include <filesystem>
#include <string>

#include "libscan/verify/truth.h"

namespace scan {

// sphere (radius 1), torus (1 and 0.35), csg (a sharp-edged part), plate (2 x 2 x 0.02), bunny,
// smooth-bunny, or a mesh of reconbench. `data`: the folder that holds stanford-bunny and
// reconbench.
TrueSurface reconstruct_body(const std::string& name, const std::filesystem::path& data);

// The zippered bunny with its holes closed by fans about their centroids.
Mesh closed_bunny(const std::filesystem::path& data);

// The same after two passes that move each vertex, rims kept, half way to the mean of its
// neighbours.
Mesh smooth_bunny(const std::filesystem::path& data);

}  // namespace scan
