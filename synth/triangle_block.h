// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Four neighbouring triangles in floats, tested together: which of them can a ray hit at all?
//
// The answer is safe: a triangle that the test in double precision (triangle.h) finds is never
// left out, at grazing incidence, at edges and vertices, and however thin it is. What else passes
// lies within a few millionths of the scene's size of the ray, and double precision sorts it out.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "libscan/core/mesh.h"
#include "synth/triangle.h"

namespace scan::synth {

struct TriangleBlock {
  static constexpr unsigned lanes = 4;
  alignas(16) float corner[3][3][lanes];  // corner, axis, lane; unused lanes repeat the first
  std::array<std::uint32_t, 3> vertices[lanes];
  std::uint32_t triangle[lanes];
  std::uint32_t count;
};

// The same ray as a ShearedRay, rounded, for coordinates of at most `reach_m` in size.
struct CoarseRay {
  float origin[3];  // by axis of the scene frame
  float shear_x, shear_y, scale_z;
  int axis[3];
  float slack_m;  // how far the rounding moves a corner across the ray or along it
};
// With e = 2^-24 and coordinates of at most r: a corner and the origin are each off by e r, their
// difference, of at most 2 r, by e 2 r more; that is 4 e r per axis. The product with the shear (at
// most 1, off by e) is off by 4 e r + 2 e r + 2 e r, and the last difference, of at most 4 r, by
// 4 e r more: 16 e r. Along the ray (scale at most sqrt 3) it is 4 sqrt 3 e r + 4 sqrt 3 e r. The
// rest, up to 20 e r, is for the ray's own rounding and the second order.
inline void round_off(const ShearedRay& ray, double reach_m, CoarseRay& coarse) {
  for (int i = 0; i < 3; ++i) coarse.origin[i] = static_cast<float>(ray.origin[i]);
  for (int i = 0; i < 3; ++i) coarse.axis[i] = ray.axis[i];
  coarse.shear_x = static_cast<float>(ray.shear_x);
  coarse.shear_y = static_cast<float>(ray.shear_y);
  coarse.scale_z = static_cast<float>(ray.scale_z);
  coarse.slack_m = static_cast<float>(20 * 0x1p-24 * reach_m);
}

// Bit i is set if the ray may hit the block's triangle i at a distance in [near_m, far_m].
unsigned candidates(const TriangleBlock& block, const CoarseRay& ray, float near_m, float far_m);

// Groups the triangles that are named by `which` into blocks of neighbours, all full but one, and
// puts the vertices into the order in which the blocks name them: what is tested together lies
// together. The blocks name them by their new places; vertices that no block names are dropped.
std::vector<TriangleBlock> make_blocks(std::vector<Eigen::Vector3d>& vertices,
                                       std::span<const Triangle> triangles,
                                       const std::vector<std::uint32_t>& which);

}  // namespace scan::synth
