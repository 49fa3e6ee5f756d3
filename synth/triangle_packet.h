// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A block of triangles against a packet of neighbouring rays at once.
#pragma once

#include "synth/triangle_block.h"

namespace scan::synth {

struct CoarsePacket {
  static constexpr unsigned size = 16;
  // By place in the packet; axes are the rays' own: across, across, along.
  alignas(64) float origin[3][size] = {};
  alignas(64) float shear_x[size] = {};
  alignas(64) float shear_y[size] = {};
  alignas(64) float scale_z[size] = {};
  int axis[3] = {};
  float slack_m = 0;
  bool empty = true;
  bool mixed = false;  // the rays' axes differ: the packet cannot be used
};

inline void put(CoarsePacket& packet, unsigned place, const CoarseRay& ray) {
  for (int i = 0; i < 3; ++i) {
    if (packet.empty) packet.axis[i] = ray.axis[i];
    packet.mixed |= packet.axis[i] != ray.axis[i];
    packet.origin[i][place] = ray.origin[ray.axis[i]];
  }
  packet.empty = false;
  packet.shear_x[place] = ray.shear_x;
  packet.shear_y[place] = ray.shear_y;
  packet.scale_z[place] = ray.scale_z;
  packet.slack_m = ray.slack_m;
}

// As `candidates` for each of the rays at the places [first, first + count), count 4, 8 or 16: bit
// i of rays_of[lane] is set if the ray at first + i may hit that triangle.
void candidates(const TriangleBlock& block, const CoarsePacket& packet, unsigned first,
                unsigned count, const float* near_m, const float* far_m,
                unsigned (&rays_of)[TriangleBlock::lanes]);

}  // namespace scan::synth
