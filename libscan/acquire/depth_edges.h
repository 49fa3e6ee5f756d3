// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pixels that a matching window cannot tell from the other side of a depth edge.
#pragma once

#include <vector>

#include "libscan/core/image.h"

namespace scan::decoding {

// True for each matched pixel within `margin_px` (in columns and rows) of an edge: of a jump in
// disparity of more than 1 px beside a slope of one half, or of a hole (NaN) that holds 5 x 5
// pixels. There windows straddle two surfaces, or surface and nothing, and the stronger texture
// decides (foreground fattening; Hirschmueller 2008, section 2.5).
std::vector<char> near_depth_edge(const Image<float>& disparity_px, int margin_px);

}  // namespace scan::decoding
