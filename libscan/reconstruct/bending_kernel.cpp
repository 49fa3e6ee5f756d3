// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/bending_kernel.h"

#include <algorithm>
#include <cstring>

#include "libscan/core/instruction_sets.h"

namespace scan {
namespace {

constexpr int width = 4, side = bending_side, plane = side * side;
constexpr int size_by_z = width * plane, size_by_y = width * width * side;
constexpr int mass = 0, stiffness = 1, bending = 2;

template <class Real, int lanes>
struct Register {
  using Type __attribute__((vector_size(lanes * sizeof(Real)))) = Real;
};

template <class Real, class Vector>
SCAN_INLINE void load(const Real* from, Vector& to) {
  std::memcpy(&to, from, sizeof(to));
}

template <class Real, class Vector>
SCAN_INLINE void store(const Vector& from, Real* to) {
  std::memcpy(to, &from, sizeof(from));
}

// Along z: mass, stiffness and bending sums of the 8 x 8 columns.
template <int lanes, class Real>
SCAN_INLINE void sum_along_z(const Real* cube, const AxisStencil<Real>& axis, Real* out) {
  using Vector = typename Register<Real, lanes>::Type;
  for (int z = 0; z < width; ++z)
    for (int column = 0; column < plane; column += lanes) {
      Vector m = {}, k = {}, b = {};
      for (int tap = 0; tap < 5; ++tap) {
        Vector from;
        load(cube + (z + tap) * plane + column, from);
        m += axis.taps[mass][tap][z] * from;
        k += axis.taps[stiffness][tap][z] * from;
        b += axis.taps[bending][tap][z] * from;
      }
      Real* to = out + z * plane + column;
      store(m, to);
      store(k, to + size_by_z);
      store(b, to + 2 * size_by_z);
    }
}

// Along y: what the mass, stiffness and bending along x are applied to.
template <int lanes, class Real>
SCAN_INLINE void sum_along_y(const Real* in, const AxisStencil<Real>& axis, Real* out) {
  using Vector = typename Register<Real, lanes>::Type;
  for (int line = 0; line < width * width; ++line)
    for (int x = 0; x < side; x += lanes) {
      const int z = line / width, y = line % width;
      Vector to_mass = {}, to_stiffness = {}, to_bending = {};
      for (int tap = 0; tap < 5; ++tap) {
        const Real m = axis.taps[mass][tap][y], k2 = 2 * axis.taps[stiffness][tap][y],
                   b = axis.taps[bending][tap][y];
        const Real* from = in + (z * side + y + tap) * side + x;
        Vector zm, zk, zb;
        load(from, zm);
        load(from + size_by_z, zk);
        load(from + 2 * size_by_z, zb);
        to_mass += b * zm + m * zb + k2 * zk;
        to_stiffness += k2 * zm + (m + m) * zk;
        to_bending += m * zm;
      }
      Real* to = out + line * side + x;
      store(to_mass, to);
      store(to_stiffness, to + size_by_y);
      store(to_bending, to + 2 * size_by_y);
    }
}

template <int lanes, class Real>
SCAN_INLINE void sum_along_x(const Real* in, const AxisStencil<Real>& axis, Real scale, Real* sum) {
  using Vector = typename Register<Real, lanes>::Type;
  for (int line = 0; line < width * width; ++line)
    for (int x = 0; x < width; x += lanes) {
      Vector total = {}, weight, from;
      for (int kind = 0; kind < 3; ++kind)
        for (int tap = 0; tap < 5; ++tap) {
          load(axis.taps[kind][tap] + x, weight);
          load(in + kind * size_by_y + line * side + tap + x, from);
          total += weight * from;
        }
      load(sum + line * width + x, from);
      from += scale * total;
      store(from, sum + line * width + x);
    }
}

template <int bytes, class Real>
SCAN_INLINE void add_all(const Real* cube, const AxisStencil<Real>& x, const AxisStencil<Real>& y,
                         const AxisStencil<Real>& z, Real scale, Real* sum) {
  constexpr int lanes = bytes / static_cast<int>(sizeof(Real));
  alignas(64) Real by_z[3 * size_by_z], by_y[3 * size_by_y];
  sum_along_z<lanes>(cube, z, by_z);
  sum_along_y<std::min(lanes, side)>(by_z, y, by_y);
  sum_along_x<std::min(lanes, width)>(by_y, x, scale, sum);
}

template <class Real>
void add_plain(const Real* cube, const AxisStencil<Real>& x, const AxisStencil<Real>& y,
               const AxisStencil<Real>& z, Real scale, Real* sum) {
  add_all<16>(cube, x, y, z, scale, sum);
}
template <class Real>
SCAN_AVX2 void add_avx2(const Real* cube, const AxisStencil<Real>& x, const AxisStencil<Real>& y,
                        const AxisStencil<Real>& z, Real scale, Real* sum) {
  add_all<32>(cube, x, y, z, scale, sum);
}
template <class Real>
SCAN_AVX512 void add_avx512(const Real* cube, const AxisStencil<Real>& x,
                            const AxisStencil<Real>& y, const AxisStencil<Real>& z, Real scale,
                            Real* sum) {
  add_all<64>(cube, x, y, z, scale, sum);
}

template <class Real>
const Versions<BendingKernel<Real>> versions(add_plain<Real>, add_avx2<Real>, add_avx512<Real>);

}  // namespace

template <class Real>
void add_bending(const Real* cube, const AxisStencil<Real>& x, const AxisStencil<Real>& y,
                 const AxisStencil<Real>& z, Real scale, Real* sum) {
  versions<Real>.fastest()(cube, x, y, z, scale, sum);
}

template <class Real>
std::span<BendingKernel<Real>* const> bending_kernels() {
  return versions<Real>.all();
}

template void add_bending(const float*, const AxisStencil<float>&, const AxisStencil<float>&,
                          const AxisStencil<float>&, float, float*);
template void add_bending(const double*, const AxisStencil<double>&, const AxisStencil<double>&,
                          const AxisStencil<double>&, double, double*);
template std::span<BendingKernel<float>* const> bending_kernels<float>();
template std::span<BendingKernel<double>* const> bending_kernels<double>();

}  // namespace scan
