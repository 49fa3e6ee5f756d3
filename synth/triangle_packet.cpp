// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/triangle_packet.h"

#include <algorithm>
#include <cstring>

// Wide values never cross a call: all that takes them is inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace scan::synth {
namespace {

// The function below is compiled for the processor's widest registers too. They change how its
// roundings fall, hence no answer: it only proposes, within its bound.
template <unsigned count>
struct Wide {
  using Floats [[gnu::vector_size(4 * count)]] = float;
};

constexpr float powers_of_two[16] = {0x1p0F,  0x1p1F,  0x1p2F,  0x1p3F, 0x1p4F,  0x1p5F,
                                     0x1p6F,  0x1p7F,  0x1p8F,  0x1p9F, 0x1p10F, 0x1p11F,
                                     0x1p12F, 0x1p13F, 0x1p14F, 0x1p15F};

#define SCAN_INLINE [[gnu::always_inline]] inline

template <class Floats>
SCAN_INLINE void load(const float* from, Floats& to) {
  std::memcpy(&to, from, sizeof to);
}

template <class Floats>
SCAN_INLINE Floats smaller(Floats a, Floats b) {
  return a < b ? a : b;
}
template <class Floats>
SCAN_INLINE Floats larger(Floats a, Floats b) {
  return a < b ? b : a;
}

// Bit i is set if value i is not negative. Sums of powers of two, since the compiler takes masks of
// wide registers apart.
template <unsigned count>
SCAN_INLINE unsigned bits(const typename Wide<count>::Floats& values) {
  using Floats = typename Wide<count>::Floats;
  Floats power;
  load(powers_of_two, power);
  const Floats sum = values >= 0 ? power : Floats{};
  if constexpr (count == 4) {
    return static_cast<unsigned>((sum[0] + sum[1]) + (sum[2] + sum[3]));
  } else {
    float parts[count];
    std::memcpy(parts, &sum, sizeof parts);
    typename Wide<4>::Floats total = {}, part;
    for (unsigned i = 0; i < count; i += 4) {
      load(parts + i, part);
      total += part;
    }
    return static_cast<unsigned>((total[0] + total[1]) + (total[2] + total[3]));
  }
}

template <unsigned count>
struct Rays {
  using Floats = typename Wide<count>::Floats;
  Floats origin[3], shear_x, shear_y, scale_z, near_m, far_m;
};

// How much room the triangle in that lane leaves of each bound, negative for a miss. See candidates
// in triangle_block.cpp: the same formulas, with the rays side by side.
template <unsigned count>
SCAN_INLINE void room_left(const TriangleBlock& block, unsigned lane, const int (&axis)[3],
                           float slack_m, const Rays<count>& rays,
                           typename Wide<count>::Floats& room) {
  using Floats = typename Wide<count>::Floats;
  Floats x[3], y[3], z[3], across = {};
  for (int i = 0; i < 3; ++i) {
    const auto& corner = block.corner[i];
    const Floats along = corner[axis[2]][lane] - rays.origin[2];
    x[i] = corner[axis[0]][lane] - rays.origin[0] - rays.shear_x * along;
    y[i] = corner[axis[1]][lane] - rays.origin[1] - rays.shear_y * along;
    z[i] = rays.scale_z * along;
    across = larger(across, larger(larger(x[i], -x[i]), larger(y[i], -y[i])));
  }
  const Floats u = x[2] * y[1] - y[2] * x[1];
  const Floats v = x[0] * y[2] - y[0] * x[2];
  const Floats w = x[1] * y[0] - y[1] * x[0];
  const Floats slack = slack_m * (5 * across + 2 * slack_m);
  const Floats low = smaller(smaller(u, v), w), high = larger(larger(u, v), w);
  const Floats front = smaller(smaller(z[0], z[1]), z[2]);
  const Floats back = larger(larger(z[0], z[1]), z[2]);
  room =
      smaller(larger(slack + low, slack - high), smaller(rays.far_m - front, back - rays.near_m));
}

template <unsigned count>
SCAN_INLINE void test(const TriangleBlock& block, const CoarsePacket& packet, unsigned first,
                      const float* near_m, const float* far_m, unsigned* rays_of) {
  Rays<count> rays;
  for (int i = 0; i < 3; ++i) load(packet.origin[i] + first, rays.origin[i]);
  load(packet.shear_x + first, rays.shear_x);
  load(packet.shear_y + first, rays.shear_y);
  load(packet.scale_z + first, rays.scale_z);
  load(near_m, rays.near_m);
  load(far_m, rays.far_m);
  rays.near_m -= packet.slack_m;
  rays.far_m += packet.slack_m;
  typename Wide<count>::Floats room[TriangleBlock::lanes], most;
  for (unsigned lane = 0; lane < TriangleBlock::lanes; ++lane) {
    room_left<count>(block, lane, packet.axis, packet.slack_m, rays, room[lane]);
    most = lane == 0 ? room[lane] : larger(most, room[lane]);
    rays_of[lane] = 0;
  }
  if (bits<count>(most) == 0) return;
  for (unsigned lane = 0; lane < block.count; ++lane) rays_of[lane] = bits<count>(room[lane]);
}

using Test = void(const TriangleBlock&, const CoarsePacket&, unsigned, unsigned, const float*,
                  const float*, unsigned*);

SCAN_INLINE void test_any(const TriangleBlock& block, const CoarsePacket& packet, unsigned first,
                          unsigned count, const float* near_m, const float* far_m,
                          unsigned* rays_of) {
  if (count == 16)
    test<16>(block, packet, first, near_m, far_m, rays_of);
  else if (count == 8)
    test<8>(block, packet, first, near_m, far_m, rays_of);
  else
    test<4>(block, packet, first, near_m, far_m, rays_of);
}

void test_anywhere(const TriangleBlock& block, const CoarsePacket& packet, unsigned first,
                   unsigned count, const float* near_m, const float* far_m, unsigned* rays_of) {
  test_any(block, packet, first, count, near_m, far_m, rays_of);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void test_avx2(const TriangleBlock& block, const CoarsePacket& packet,
                                       unsigned first, unsigned count, const float* near_m,
                                       const float* far_m, unsigned* rays_of) {
  test_any(block, packet, first, count, near_m, far_m, rays_of);
}
[[gnu::target("avx512f,avx512dq,avx512vl,avx512bw")]] void test_avx512(
    const TriangleBlock& block, const CoarsePacket& packet, unsigned first, unsigned count,
    const float* near_m, const float* far_m, unsigned* rays_of) {
  test_any(block, packet, first, count, near_m, far_m, rays_of);
}

Test* widest_test() {
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw"))
    return test_avx512;
  return __builtin_cpu_supports("avx2") ? test_avx2 : test_anywhere;
}
#else
Test* widest_test() {
  return test_anywhere;
}
#endif

Test* const chosen_test = widest_test();

}  // namespace

void candidates(const TriangleBlock& block, const CoarsePacket& packet, unsigned first,
                unsigned count, const float* near_m, const float* far_m,
                unsigned (&rays_of)[TriangleBlock::lanes]) {
  chosen_test(block, packet, first, count, near_m, far_m, rays_of);
}

}  // namespace scan::synth
