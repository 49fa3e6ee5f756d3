// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The views of a pinhole camera without distortion, many at once.
#pragma once

#include <cstddef>
#include <span>

namespace scan::synth {

struct Pinhole {
  double fx_px, fy_px, cx_px, cy_px;
  double vignetting;      // share of the cos^4 law that takes effect
  double rotation[3][3];  // world from scanner
};

struct PinholeRays {
  static constexpr std::size_t most = 64;
  alignas(64) double column_px[most], row_px[most];  // given
  alignas(64) double direction[3][most];             // unit, scanner frame
  alignas(64) double in_world[3][most];
  alignas(64) double share[most];  // that vignetting leaves
};

// Of the first `count` places.
void aim(const Pinhole& pinhole, std::size_t count, PinholeRays& rays);

// The versions that this processor can run.
using PinholeKernel = void(const Pinhole& pinhole, std::size_t count, PinholeRays& rays);
std::span<PinholeKernel* const> pinhole_kernels();

}  // namespace scan::synth
