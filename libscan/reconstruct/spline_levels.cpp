// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/spline_levels.h"

#include <algorithm>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr int halo = (bending_side - block_width) / 2;

// The finer functions 2i and 2i+1 from the coarse ones i and i+1.
template <class Real>
constexpr Real near_weight = refinement_mask[1];
template <class Real>
constexpr Real far_weight = refinement_mask[0];

// Fine values of one block from the cube of 3 x 3 x 3 coarse functions they depend on.
template <class Real>
void refine_cube(const Real* coarse, Real* fine) {
  constexpr Real near = near_weight<Real>, far = far_weight<Real>;
  Real x[3 * 3 * 4], y[3 * 4 * 4];
  for (int line = 0; line < 9; ++line)
    for (int i = 0; i < 4; ++i) {
      const int first = 3 * line + i / 2;
      const Real* c = coarse + first;
      x[4 * line + i] = i % 2 == 0 ? near * c[0] + far * c[1] : far * c[0] + near * c[1];
    }
  for (int z = 0; z < 3; ++z)
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k) {
        const Real a = x[k + 4 * (i / 2 + 3 * z)], b = x[k + 4 * (i / 2 + 1 + 3 * z)];
        y[k + 4 * (i + 4 * z)] = i % 2 == 0 ? near * a + far * b : far * a + near * b;
      }
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 16; ++k) {
      const Real a = y[k + 16 * (i / 2)], b = y[k + 16 * (i / 2 + 1)];
      fine[k + 16 * i] = i % 2 == 0 ? near * a + far * b : far * a + near * b;
    }
}

constexpr int fine_wide = 10;  // functions 8B-2 ... 8B+7 act on the coarse block B

template <class Real>
constexpr std::array<Real, 4> mask_of() {
  std::array<Real, 4> mask{};
  for (std::size_t tap = 0; tap < 4; ++tap) mask[tap] = static_cast<Real>(refinement_mask[tap]);
  return mask;
}

template <class Real>
void coarsen_cube(const Real* fine, Real* coarse) {
  constexpr auto mask = mask_of<Real>();
  Real z[fine_wide * fine_wide * 4] = {}, y[fine_wide * 4 * 4] = {};
  for (int i = 0; i < 4; ++i)
    for (int tap = 0; tap < 4; ++tap)
      for (int k = 0; k < fine_wide * fine_wide; ++k)
        z[k + fine_wide * fine_wide * i] +=
            mask[tap] * fine[k + fine_wide * fine_wide * (2 * i + tap)];
  for (int s = 0; s < 4; ++s)
    for (int i = 0; i < 4; ++i)
      for (int tap = 0; tap < 4; ++tap)
        for (int k = 0; k < fine_wide; ++k)
          y[k + fine_wide * (i + 4 * s)] +=
              mask[tap] * z[k + fine_wide * (2 * i + tap + fine_wide * s)];
  for (int line = 0; line < 16; ++line)
    for (int i = 0; i < 4; ++i)
      for (int tap = 0; tap < 4; ++tap)
        coarse[i + 4 * line] += mask[tap] * y[2 * i + tap + fine_wide * line];
}

// The part of a cube's axis (`width` functions, the first is `low` before the middle block) that
// the block at offset d covers.
template <int low, int width>
struct Overlap {
  int first, end;  // in the cube
  explicit constexpr Overlap(int d)
      : first(std::max(0, block_width * d + low)),
        end(std::min(width, block_width * (d + 1) + low)) {}
};

// Copies what the block at offset (dx, dy, dz) has of a cube.
template <int low, int width, int dx, class Real>
void copy_part(const Real* block, int dy, int dz, Real* cube) {
  using Part = Overlap<low, width>;
  constexpr Part x(dx);
  const Part y(dy), z(dz);
  if constexpr (x.end > x.first)
    for (int k = z.first; k < z.end; ++k)
      for (int i = y.first; i < y.end; ++i)
        std::copy_n(block + slot_in_block(x.first - block_width * dx - low,
                                          i - block_width * dy - low, k - block_width * dz - low),
                    x.end - x.first, cube + x.first + width * (i + width * k));
}

// Copies from the blocks of a table of 27 into a cube. Returns whether any block is there.
template <int low, int width, class Real>
bool gather_table(const std::array<std::int32_t, 27>& table, const std::vector<Real>& values,
                  Real* cube) {
  const std::size_t blocks = values.size() / block_size;
  bool any = false;
  const auto block_at = [&](int dx, int dy, int dz) -> const Real* {
    const std::int32_t block = table[neighbour_slot(dx, dy, dz)];
    if (block < 0 || static_cast<std::size_t>(block) >= blocks) return nullptr;
    any = true;
    return values.data() + static_cast<std::size_t>(block) * block_size;
  };
  std::fill_n(cube, width * width * width, Real{0});
  constexpr int from = low > 0 ? -1 : 0;
  for (int dz = from; dz <= 1; ++dz)
    for (int dy = from; dy <= 1; ++dy) {
      if constexpr (from < 0)
        if (const Real* block = block_at(-1, dy, dz))
          copy_part<low, width, -1>(block, dy, dz, cube);
      if (const Real* block = block_at(0, dy, dz)) copy_part<low, width, 0>(block, dy, dz, cube);
      if (const Real* block = block_at(1, dy, dz)) copy_part<low, width, 1>(block, dy, dz, cube);
    }
  return any;
}

}  // namespace

template <class Real>
LevelArraysOf<Real> active_arrays(const OctreeGrid& grid) {
  LevelArraysOf<Real> arrays;
  for (const BlockLevel& level : grid.levels) arrays.emplace_back(level.active * block_size);
  return arrays;
}

template <class Real>
void gather_cell_functions(const BlockLevel& level, const std::vector<Real>& values,
                           std::size_t block, Real* cube) {
  gather_table<0, block_cell_functions>(level.neighbours[block], values, cube);
}

template <class Real>
void prolong(const OctreeGrid& grid, std::size_t l, const std::vector<Real>& coarse,
             std::vector<Real>& fine) {
  const BlockLevel& level = grid.levels[l];
  const BlockLevel& coarser = grid.levels[l - 1];
  parallel_for(level.blocks.size(), [&](std::size_t b) {
    Real* out = fine.data() + b * block_size;
    if (level.parent[b] < 0) {
      std::fill(out, out + block_size, Real{0});
      return;
    }
    // The block's functions depend on the coarse functions 2*place ... 2*place+2.
    constexpr int width = 5;
    Real cube[width * width * width], part[27];
    gather_table<0, width>(coarser.neighbours[level.parent[b]], coarse, cube);
    const BlockPlace& p = level.blocks[b];
    const int x0 = p[0] % 2 * 2, y0 = p[1] % 2 * 2, z0 = p[2] % 2 * 2;
    for (int z = 0; z < 3; ++z)
      for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x)
          part[x + 3 * (y + 3 * z)] = cube[x0 + x + width * (y0 + y + width * (z0 + z))];
    refine_cube(part, out);
  });
}

template <class Real>
void restrict_add(const OctreeGrid& grid, std::size_t l, const std::vector<Real>& fine,
                  std::vector<Real>& coarse) {
  const BlockLevel& level = grid.levels[l];
  parallel_for(level.blocks.size(), [&](std::size_t b) {
    Real cube[fine_wide * fine_wide * fine_wide];
    // Two child blocks lie side by side: their functions start two behind the cube's first.
    if (gather_table<2, fine_wide>(level.children[b], fine, cube))
      coarsen_cube(cube, coarse.data() + b * block_size);
  });
}

BendingStencil::BendingStencil(int depth)
    : inverse_cell_(1 << depth), rows_(stencil_rows(1 << depth, block_width)) {
  const auto set_axes = [&]<class Real>(std::vector<AxisStencil<Real>>& axes) {
    axes.resize(rows_.size() / block_width);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      for (int tap = 0; tap < 5; ++tap) {
        auto& taps = axes[i / block_width].taps;
        taps[0][tap][i % block_width] = static_cast<Real>(rows_[i].mass[tap]);
        taps[1][tap][i % block_width] = static_cast<Real>(rows_[i].stiffness[tap]);
        taps[2][tap][i % block_width] = static_cast<Real>(rows_[i].bending[tap]);
      }
  };
  set_axes(std::get<0>(axes_));
  set_axes(std::get<1>(axes_));
}

template <class Real>
void BendingStencil::add(const BlockLevel& level, const std::vector<Real>& values,
                         std::size_t block, Real* sum) const {
  alignas(64) Real cube[bending_side * bending_side * bending_side];
  if (!gather_table<halo, bending_side>(level.neighbours[block], values, cube)) return;
  const BlockPlace& p = level.blocks[block];
  const auto& axes = std::get<std::vector<AxisStencil<Real>>>(axes_);
  // With cells of width h, |D^2 f|^2 dV scales by h^-4 h^3.
  add_bending(cube, axes[p[0]], axes[p[1]], axes[p[2]], static_cast<Real>(inverse_cell_), sum);
}

double BendingStencil::entry(const BlockPlace& place, int slot, int tap_x, int tap_y,
                             int tap_z) const {
  const StencilRow& x = rows_[place[0] * block_width + slot % 4];
  const StencilRow& y = rows_[place[1] * block_width + slot / 4 % 4];
  const StencilRow& z = rows_[place[2] * block_width + slot / 16];
  const double mx = x.mass[tap_x], my = y.mass[tap_y], mz = z.mass[tap_z];
  const double kx = x.stiffness[tap_x], ky = y.stiffness[tap_y], kz = z.stiffness[tap_z];
  return inverse_cell_ *
         (x.bending[tap_x] * my * mz + mx * y.bending[tap_y] * mz + mx * my * z.bending[tap_z] +
          2 * (kx * ky * mz + kx * my * kz + mx * ky * kz));
}

template LevelArraysOf<float> active_arrays(const OctreeGrid&);
template void prolong(const OctreeGrid&, std::size_t, const std::vector<float>&,
                      std::vector<float>&);
template void restrict_add(const OctreeGrid&, std::size_t, const std::vector<float>&,
                           std::vector<float>&);
template void gather_cell_functions(const BlockLevel&, const std::vector<float>&, std::size_t,
                                    float*);
template void BendingStencil::add(const BlockLevel&, const std::vector<float>&, std::size_t,
                                  float*) const;
template LevelArraysOf<double> active_arrays(const OctreeGrid&);
template void prolong(const OctreeGrid&, std::size_t, const std::vector<double>&,
                      std::vector<double>&);
template void restrict_add(const OctreeGrid&, std::size_t, const std::vector<double>&,
                           std::vector<double>&);
template void gather_cell_functions(const BlockLevel&, const std::vector<double>&, std::size_t,
                                    double*);
template void BendingStencil::add(const BlockLevel&, const std::vector<double>&, std::size_t,
                                  double*) const;

}  // namespace scan
