// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/spline_levels.h"

#include <algorithm>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr int halo = 2;                       // reach of the stencil, functions
constexpr int wide = block_width + 2 * halo;  // side of what a block's stencil reads
constexpr int plane = wide * wide;
constexpr int lanes_z = block_width * plane;
constexpr int lanes_y = block_width * block_width * wide;

// The finer functions 2i and 2i+1 from the coarse ones i and i+1.
constexpr double near_weight = refinement_mask[1], far_weight = refinement_mask[0];

// Fine values of one block from the cube of 3 x 3 x 3 coarse functions they depend on.
void refine_cube(const double* coarse, double* fine) {
  double x[3 * 3 * 4], y[3 * 4 * 4];
  for (int line = 0; line < 9; ++line)
    for (int i = 0; i < 4; ++i) {
      const int first = 3 * line + i / 2;
      const double* c = coarse + first;
      x[4 * line + i] = i % 2 == 0 ? near_weight * c[0] + far_weight * c[1]
                                   : far_weight * c[0] + near_weight * c[1];
    }
  for (int z = 0; z < 3; ++z)
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k) {
        const double a = x[k + 4 * (i / 2 + 3 * z)], b = x[k + 4 * (i / 2 + 1 + 3 * z)];
        y[k + 4 * (i + 4 * z)] =
            i % 2 == 0 ? near_weight * a + far_weight * b : far_weight * a + near_weight * b;
      }
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 16; ++k) {
      const double a = y[k + 16 * (i / 2)], b = y[k + 16 * (i / 2 + 1)];
      fine[k + 16 * i] =
          i % 2 == 0 ? near_weight * a + far_weight * b : far_weight * a + near_weight * b;
    }
}

constexpr int fine_wide = 10;  // functions 8B-2 ... 8B+7 act on the coarse block B

void coarsen_cube(const double* fine, double* coarse) {
  double z[fine_wide * fine_wide * 4] = {}, y[fine_wide * 4 * 4] = {};
  for (int i = 0; i < 4; ++i)
    for (int tap = 0; tap < 4; ++tap)
      for (int k = 0; k < fine_wide * fine_wide; ++k)
        z[k + fine_wide * fine_wide * i] +=
            refinement_mask[tap] * fine[k + fine_wide * fine_wide * (2 * i + tap)];
  for (int s = 0; s < 4; ++s)
    for (int i = 0; i < 4; ++i)
      for (int tap = 0; tap < 4; ++tap)
        for (int k = 0; k < fine_wide; ++k)
          y[k + fine_wide * (i + 4 * s)] +=
              refinement_mask[tap] * z[k + fine_wide * (2 * i + tap + fine_wide * s)];
  for (int line = 0; line < 16; ++line)
    for (int i = 0; i < 4; ++i)
      for (int tap = 0; tap < 4; ++tap)
        coarse[i + 4 * line] += refinement_mask[tap] * y[2 * i + tap + fine_wide * line];
}

// Copies from the blocks of a table of 27 into a cube that starts `low` functions before the middle
// block. Returns whether any block is there.
bool gather_table(const std::array<std::int32_t, 27>& table, const std::vector<double>& values,
                  int low, int width, double* cube) {
  bool any = false;
  const int size = width * width * width;
  std::fill(cube, cube + size, 0.0);
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const std::int32_t block = table[neighbour_slot(dx, dy, dz)];
        if (block < 0 || (block + std::size_t{1}) * block_size > values.size()) continue;
        const double* from = values.data() + static_cast<std::size_t>(block) * block_size;
        const int ox = 4 * dx + low, oy = 4 * dy + low, oz = 4 * dz + low;
        const int x0 = std::max(0, -ox), x1 = std::min(4, width - ox);
        any = any || x1 > x0;
        for (int z = std::max(0, -oz); z < std::min(4, width - oz); ++z)
          for (int y = std::max(0, -oy); y < std::min(4, width - oy); ++y)
            for (int x = x0; x < x1; ++x)
              cube[x + ox + width * (y + oy + width * (z + oz))] = from[slot_in_block(x, y, z)];
      }
  return any;
}

// Along z: mass, stiffness and bending sums of the 8 x 8 columns.
void sum_along_z(const double* cube, const StencilRow* rows, double (&out)[3][lanes_z]) {
  for (int z = 0; z < block_width; ++z) {
    const int lane = z * plane;
    double* m = out[0] + lane;
    double* k = out[1] + lane;
    double* b = out[2] + lane;
    std::fill(m, m + plane, 0.0);
    std::fill(k, k + plane, 0.0);
    std::fill(b, b + plane, 0.0);
    for (int tap = 0; tap < 5; ++tap) {
      const double wm = rows[z].mass[tap], wk = rows[z].stiffness[tap], wb = rows[z].bending[tap];
      const int lane_read = (z + tap) * plane;
      const double* from = cube + lane_read;
      for (int i = 0; i < plane; ++i) {
        m[i] += wm * from[i];
        k[i] += wk * from[i];
        b[i] += wb * from[i];
      }
    }
  }
}

// Along y: what the mass, stiffness and bending along x are applied to.
void sum_along_y(const double (&in)[3][lanes_z], const StencilRow* rows,
                 double (&out)[3][lanes_y]) {
  for (int z = 0; z < block_width; ++z)
    for (int y = 0; y < block_width; ++y) {
      const int lane = (z * block_width + y) * wide;
      double* to_mass = out[0] + lane;
      double* to_stiffness = out[1] + lane;
      double* to_bending = out[2] + lane;
      std::fill(to_mass, to_mass + wide, 0.0);
      std::fill(to_stiffness, to_stiffness + wide, 0.0);
      std::fill(to_bending, to_bending + wide, 0.0);
      for (int tap = 0; tap < 5; ++tap) {
        const double m = rows[y].mass[tap], k = 2 * rows[y].stiffness[tap],
                     b = rows[y].bending[tap];
        const int at = (z * wide + y + tap) * wide;
        for (int x = 0; x < wide; ++x) {
          const double zm = in[0][at + x], zk = in[1][at + x], zb = in[2][at + x];
          to_mass[x] += b * zm + m * zb + k * zk;
          to_stiffness[x] += k * zm + 2 * m * zk;
          to_bending[x] += m * zm;
        }
      }
    }
}

}  // namespace

LevelArrays active_arrays(const OctreeGrid& grid, double value) {
  LevelArrays arrays;
  for (const BlockLevel& level : grid.levels) arrays.emplace_back(level.active * block_size, value);
  return arrays;
}

void gather(const BlockLevel& level, const std::vector<double>& values, std::size_t block, int low,
            int width, double* cube) {
  gather_table(level.neighbours[block], values, low, width, cube);
}

void prolong(const OctreeGrid& grid, std::size_t l, const std::vector<double>& coarse,
             std::vector<double>& fine) {
  const BlockLevel& level = grid.levels[l];
  const BlockLevel& coarser = grid.levels[l - 1];
  parallel_for(level.blocks.size(), [&](std::size_t b) {
    double* out = fine.data() + b * block_size;
    if (level.parent[b] < 0) {
      std::fill(out, out + block_size, 0.0);
      return;
    }
    // The block's functions depend on the coarse functions 2*place ... 2*place+2.
    constexpr int width = 5;
    double cube[width * width * width], part[27];
    gather(coarser, coarse, level.parent[b], 0, width, cube);
    const BlockPlace& p = level.blocks[b];
    const int x0 = p[0] % 2 * 2, y0 = p[1] % 2 * 2, z0 = p[2] % 2 * 2;
    for (int z = 0; z < 3; ++z)
      for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x)
          part[x + 3 * (y + 3 * z)] = cube[x0 + x + width * (y0 + y + width * (z0 + z))];
    refine_cube(part, out);
  });
}

void restrict_add(const OctreeGrid& grid, std::size_t l, const std::vector<double>& fine,
                  std::vector<double>& coarse) {
  const BlockLevel& level = grid.levels[l];
  parallel_for(level.blocks.size(), [&](std::size_t b) {
    double cube[fine_wide * fine_wide * fine_wide];
    // Two child blocks lie side by side: their functions start two behind the cube's first.
    if (gather_table(level.children[b], fine, 2, fine_wide, cube))
      coarsen_cube(cube, coarse.data() + b * block_size);
  });
}

BendingStencil::BendingStencil(int depth)
    : inverse_cell_(1 << depth), rows_(stencil_rows(1 << depth, block_width)) {}

void BendingStencil::add(const BlockLevel& level, const std::vector<double>& values,
                         std::size_t block, double factor, double* sum) const {
  double cube[wide * wide * wide], by_z[3][lanes_z], by_y[3][lanes_y];
  if (!gather_table(level.neighbours[block], values, halo, wide, cube)) return;
  const BlockPlace& p = level.blocks[block];
  const int row_z = p[2] * block_width, row_y = p[1] * block_width;
  sum_along_z(cube, &rows_[row_z], by_z);
  sum_along_y(by_z, &rows_[row_y], by_y);
  // With cells of width h, |D^2 f|^2 dV scales by h^-4 h^3.
  const double scale = factor * inverse_cell_;
  for (int line = 0; line < block_width * block_width; ++line)
    for (int x = 0; x < block_width; ++x) {
      const StencilRow& row = rows_[p[0] * block_width + x];
      double total = 0;
      for (int tap = 0; tap < 5; ++tap) {
        const int at = line * wide + x + tap;
        total += row.mass[tap] * by_y[0][at] + row.stiffness[tap] * by_y[1][at] +
                 row.bending[tap] * by_y[2][at];
      }
      sum[x + block_width * line] += scale * total;
    }
}

double BendingStencil::diagonal(const BlockPlace& place, int slot) const {
  const StencilRow& x = rows_[place[0] * block_width + slot % 4];
  const StencilRow& y = rows_[place[1] * block_width + slot / 4 % 4];
  const StencilRow& z = rows_[place[2] * block_width + slot / 16];
  const double mx = x.mass[2], my = y.mass[2], mz = z.mass[2];
  const double kx = x.stiffness[2], ky = y.stiffness[2], kz = z.stiffness[2];
  return inverse_cell_ * (x.bending[2] * my * mz + mx * y.bending[2] * mz + mx * my * z.bending[2] +
                          2 * (kx * ky * mz + kx * my * kz + mx * ky * kz));
}

}  // namespace scan
