// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/bending_kernel.h"

#include <cstring>

#include "libscan/core/instruction_sets.h"

namespace scan {
namespace {

constexpr int width = 4, side = bending_side, plane = side * side;
constexpr int size_by_z = width * plane, size_by_y = width * width * side;
constexpr int mass = 0, stiffness = 1, bending = 2;

template <int lanes>
struct Register;
template <>
struct Register<2> {
  using Type = double __attribute__((vector_size(16)));
};
template <>
struct Register<4> {
  using Type = double __attribute__((vector_size(32)));
};
template <>
struct Register<8> {
  using Type = double __attribute__((vector_size(64)));
};

template <class Vector>
SCAN_INLINE void load(const double* from, Vector& to) {
  std::memcpy(&to, from, sizeof(to));
}

template <class Vector>
SCAN_INLINE void store(const Vector& from, double* to) {
  std::memcpy(to, &from, sizeof(from));
}

// Along z: mass, stiffness and bending sums of the 8 x 8 columns.
template <int lanes>
SCAN_INLINE void sum_along_z(const double* cube, const AxisStencil& axis, double* out) {
  using Vector = typename Register<lanes>::Type;
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
      double* to = out + z * plane + column;
      store(m, to);
      store(k, to + size_by_z);
      store(b, to + 2 * size_by_z);
    }
}

// Along y: what the mass, stiffness and bending along x are applied to.
template <int lanes>
SCAN_INLINE void sum_along_y(const double* in, const AxisStencil& axis, double* out) {
  using Vector = typename Register<lanes>::Type;
  for (int line = 0; line < width * width; ++line)
    for (int x = 0; x < side; x += lanes) {
      const int z = line / width, y = line % width;
      Vector to_mass = {}, to_stiffness = {}, to_bending = {};
      for (int tap = 0; tap < 5; ++tap) {
        const double m = axis.taps[mass][tap][y], k2 = 2 * axis.taps[stiffness][tap][y],
                     b = axis.taps[bending][tap][y];
        const double* from = in + (z * side + y + tap) * side + x;
        Vector zm, zk, zb;
        load(from, zm);
        load(from + size_by_z, zk);
        load(from + 2 * size_by_z, zb);
        to_mass += b * zm + m * zb + k2 * zk;
        to_stiffness += k2 * zm + (m + m) * zk;
        to_bending += m * zm;
      }
      double* to = out + line * side + x;
      store(to_mass, to);
      store(to_stiffness, to + size_by_y);
      store(to_bending, to + 2 * size_by_y);
    }
}

template <int lanes>
SCAN_INLINE void sum_along_x(const double* in, const AxisStencil& axis, double scale, double* sum) {
  using Vector = typename Register<lanes>::Type;
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

template <int lanes>
SCAN_INLINE void add_all(const double* cube, const AxisStencil& x, const AxisStencil& y,
                         const AxisStencil& z, double scale, double* sum) {
  alignas(64) double by_z[3 * size_by_z], by_y[3 * size_by_y];
  sum_along_z<lanes>(cube, z, by_z);
  sum_along_y<lanes>(by_z, y, by_y);
  sum_along_x < lanes<width ? lanes : width>(by_y, x, scale, sum);
}

void add_plain(const double* cube, const AxisStencil& x, const AxisStencil& y, const AxisStencil& z,
               double scale, double* sum) {
  add_all<2>(cube, x, y, z, scale, sum);
}
SCAN_AVX2 void add_avx2(const double* cube, const AxisStencil& x, const AxisStencil& y,
                        const AxisStencil& z, double scale, double* sum) {
  add_all<4>(cube, x, y, z, scale, sum);
}
SCAN_AVX512 void add_avx512(const double* cube, const AxisStencil& x, const AxisStencil& y,
                            const AxisStencil& z, double scale, double* sum) {
  add_all<8>(cube, x, y, z, scale, sum);
}

const Versions<BendingKernel> versions(add_plain, add_avx2, add_avx512);

}  // namespace

void add_bending(const double* cube, const AxisStencil& x, const AxisStencil& y,
                 const AxisStencil& z, double scale, double* sum) {
  versions.fastest()(cube, x, y, z, scale, sum);
}

std::span<BendingKernel* const> bending_kernels() {
  return versions.all();
}

}  // namespace scan
