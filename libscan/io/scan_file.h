// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Scans, clouds and meshes by file name; the format follows the ending.
#pragma once

#include <filesystem>

#include "libscan/core/mesh.h"
#include "libscan/core/scan.h"

namespace scan {

// .ply .pcd .xyz .txt .asc .npy: points with what else the file knows. A PLY with a `range_grid`
// element (Stanford) gets its grid, ray indices and viewpoint (scan_ply.h); one that libscan wrote
// gets everything back.
// The name is the file's stem. Points that are not finite are dropped and counted in misses["not
// finite"]. Throws scan::Error (input) for a file with no valid point.
Scan read_scan(const std::filesystem::path& path);

// .ply keeps everything of a Scan (misses, grid, viewpoint, guess as comments); .pcd and .xyz keep
// points, normals and intensity. Written whole or not at all.
void write_scan(const std::filesystem::path& path, const Scan& scan);

// .ply .obj .stl .off .glb .gltf: a triangle mesh, vertices welded for formats without topology
// (STL). scan::Error (input) if there are no triangles.
Mesh read_mesh(const std::filesystem::path& path);

// The same with texture coordinates, which .obj, .glb and .gltf can have.
TexturedMesh read_textured_mesh(const std::filesystem::path& path);

// .ply .obj .stl .off; written whole or not at all.
void write_mesh(const std::filesystem::path& path, const Mesh& mesh);

// scan::Error (output) unless write_scan or write_mesh know the ending: before long work starts.
void check_scan_ending(const std::filesystem::path& path);
void check_mesh_ending(const std::filesystem::path& path);

// True for a PLY with faces and for the formats of meshes alone, false for points.
bool holds_triangles(const std::filesystem::path& path);

// True for a PLY that lists no face (`element face 0`), as mesh programs write clouds.
bool lists_no_face(const std::filesystem::path& path);

// Of those, true for a surface that came out empty: it has no vertex either, or the vertices carry
// `support_m`, which only surfaces have (surface_file.h). They are no cloud that someone measured.
bool is_emptied_surface(const std::filesystem::path& path);

}  // namespace scan
