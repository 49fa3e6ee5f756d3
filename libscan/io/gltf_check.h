// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Whether a glTF file keeps its promises, before a program that trusts them reads it.
#pragma once

#include <filesystem>

namespace scan {

// Container, JSON, buffers, views, accessors, meshes and nodes: every index and range must be
// sound. scan::Error (input) names file and place.
void check_gltf(const std::filesystem::path& path);

}  // namespace scan
