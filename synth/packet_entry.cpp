// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/packet_entry.h"

#include <limits>

#include "libscan/core/instruction_sets.h"

namespace scan::synth {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The slabs one after the other, as clip() does.
SCAN_INLINE void enter_all(const RaysByAxis& rays, const Box& box, double* __restrict start_m) {
  alignas(64) double leave_m[RaysByAxis::size], outside[RaysByAxis::size];
  for (std::size_t i = 0; i < RaysByAxis::size; ++i) {
    start_m[i] = rays.min_m[i];
    leave_m[i] = rays.max_m[i];
    outside[i] = 0;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.low[axis], high = box.high[axis];
    for (std::size_t i = 0; i < RaysByAxis::size; ++i) {
      const double o = rays.origin[axis][i], d = rays.direction[axis][i];
      const double a = (low - o) / d, b = (high - o) / d;
      const double beside = (o < low ? 1.0 : 0.0) + (o > high ? 1.0 : 0.0);
      // along the slab: all of it or nothing
      const double in = d == 0 ? (beside > 0 ? infinity : -infinity) : (b < a ? b : a);
      const double out = d == 0 ? infinity : (a < b ? b : a);
      start_m[i] = start_m[i] < in ? in : start_m[i];
      leave_m[i] = out < leave_m[i] ? out : leave_m[i];
      outside[i] += beside;
    }
  }
  for (std::size_t i = 0; i < RaysByAxis::size; ++i) {
    const double entry_m = start_m[i] <= leave_m[i] ? start_m[i] : infinity;
    start_m[i] = outside[i] > 0 ? entry_m : 0;
  }
}

void enter_plain(const RaysByAxis& rays, const Box& box, double* start_m) {
  enter_all(rays, box, start_m);
}
SCAN_AVX2 void enter_avx2(const RaysByAxis& rays, const Box& box, double* start_m) {
  enter_all(rays, box, start_m);
}
SCAN_AVX512 void enter_avx512(const RaysByAxis& rays, const Box& box, double* start_m) {
  enter_all(rays, box, start_m);
}

const Versions<EntryKernel> versions(enter_plain, enter_avx2, enter_avx512);

}  // namespace

void find_entries(const RaysByAxis& rays, const Box& box, double (&start_m)[RaysByAxis::size]) {
  versions.fastest()(rays, box, start_m);
}

std::span<EntryKernel* const> entry_kernels() {
  return versions.all();
}

}  // namespace scan::synth
