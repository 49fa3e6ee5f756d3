// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Triangle meshes as OBJ, OFF and STL. OBJ and OFF are read and written in double precision, to the
// last digit; STL holds floats by its nature (24 bits: 1 um at 10 m).
#pragma once

#include <string>
#include <string_view>

#include "libscan/core/mesh.h"

namespace scan {

// Polygons become fans; what is no geometry (materials, normals, lines) is left out. An OBJ keeps
// its texture coordinates if every face has them. An STL, text or binary, gets its equal vertices
// welded and loses triangles that are a line or a point then. scan::Error (input) names `name` and
// line, or the byte count that does not fit.
TexturedMesh parse_obj(std::string_view text, const std::string& name);
Mesh parse_off(std::string_view text, const std::string& name);
Mesh parse_stl(std::string_view bytes, const std::string& name);

std::string obj_text(const Mesh& mesh);
std::string off_text(const Mesh& mesh);
std::string stl_bytes(const Mesh& mesh);  // binary; scan::Error (input) beyond the range of float

}  // namespace scan
