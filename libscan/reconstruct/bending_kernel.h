// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The bending energy's stencil of one block, on raw arrays for vector instructions.
#pragma once

#include <span>

namespace scan {

inline constexpr int bending_side = 8;  // a block of four functions and two more on each side

// One axis of a block: [mass, stiffness, bending][tap -2 ... 2][function of the block].
struct AxisStencil {
  double taps[3][5][4];
};

// sum[4^3] += scale * (sum over axes of bending x mass x mass + 2 stiffness x stiffness x mass) of
// cube[8^3], x fastest.
using BendingKernel = void(const double* cube, const AxisStencil& x, const AxisStencil& y,
                           const AxisStencil& z, double scale, double* sum);

BendingKernel add_bending;
// The versions that this processor can run; all give the same bytes.
std::span<BendingKernel* const> bending_kernels();

}  // namespace scan
