// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Neighbouring pixels of a phase camera that see one matt surface: their indirect light is alike.
#pragma once

#include <functional>
#include <vector>

#include "synth/scanners/phase_paths.h"

namespace scan::synth {

// Square tiles of a frame, each patch within one.
inline constexpr int patch_tile_px = 32;

struct PatchPixel {
  PixelPlace place;
  Eigen::Vector3d normal;  // world, towards the lens
  double distance_m = 0;   // from the lens
  int code = 0;            // of Morton's order within the tile: its quarters follow one another
};
using Patch = std::vector<PatchPixel>;  // by their code

// Patches of the tile with that first pixel, of its pixels that are wanted: side by side without a
// crease or step, of one object that is matt (Lambert, Oren-Nayar) and without texture; no edge
// runs between a pixel's corners.
std::vector<Patch> patches_of(const PathView& view, const PixelPlace& first,
                              const std::function<bool(const PixelPlace&)>& wanted);

}  // namespace scan::synth
