// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Emission sampling: a point that the emitter lights, joined to the points of a path.
#pragma once

#include "synth/transport/path.h"

namespace scan::synth {

// Follows a ray of the emitter over smooth surfaces to the first that is not.
std::optional<LitPoint> sample_lit_point(Path& path);

// Light from the emitter over the path's lit point to the vertex.
void add_lit_point(Path& path, const Vertex& vertex);

}  // namespace scan::synth
