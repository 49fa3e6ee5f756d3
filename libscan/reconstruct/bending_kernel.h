// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The bending energy's stencil of one block, on raw arrays for vector instructions.
#pragma once

#include <span>

namespace scan {

inline constexpr int bending_side = 8;  // a block of four functions and two more on each side

// One axis of a block: [mass, stiffness, bending][tap -2 ... 2][function of the block].
template <class Real>
struct AxisStencil {
  Real taps[3][5][4];
};

// sum[4^3] += scale * (sum over axes of bending x mass x mass + 2 stiffness x stiffness x mass) of
// cube[8^3], x fastest.
template <class Real>
using BendingKernel = void(const Real* cube, const AxisStencil<Real>& x, const AxisStencil<Real>& y,
                           const AxisStencil<Real>& z, Real scale, Real* sum);

// For float and double.
template <class Real>
void add_bending(const Real* cube, const AxisStencil<Real>& x, const AxisStencil<Real>& y,
                 const AxisStencil<Real>& z, Real scale, Real* sum);
// The versions that this processor can run; all give the same bytes.
template <class Real>
std::span<BendingKernel<Real>* const> bending_kernels();

}  // namespace scan
