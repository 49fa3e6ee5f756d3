// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Meshes of other programs' scene formats, by assimp.
#pragma once

#include <filesystem>

#include "libscan/core/mesh.h"

namespace scan {

// All triangles of a glTF 2.0 scene (.gltf with its buffers, .glb), placed by their nodes, equal
// vertices welded, with the first set of texture coordinates if all parts have one; triangles that
// are a line or a point are left out. glTF holds floats (24 bits: 1 um at 10 m). scan::Error
// (input) for anything that is not sound: the file is checked before assimp sees it, and nothing
// that assimp throws gets out.
TexturedMesh read_gltf(const std::filesystem::path& path);

}  // namespace scan
