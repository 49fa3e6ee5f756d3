// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/spline_field.h"

namespace scan {
namespace {

// Calls visit(slot of 27, block, slot of block) for the cell's functions that are active on
// `level`.
template <class Visit>
void for_active_functions(const BlockLevel& level, const std::array<std::int32_t, 3>& place,
                          Visit&& visit) {
  BlockPlace low, high;
  for (int a = 0; a < 3; ++a) {
    low[a] = place[a] / block_width;
    high[a] = (place[a] + 2) / block_width;
  }
  for (int bz = low[2]; bz <= high[2]; ++bz)
    for (int by = low[1]; by <= high[1]; ++by)
      for (int bx = low[0]; bx <= high[0]; ++bx) {
        const std::int32_t block = level.find_active({bx, by, bz});
        if (block < 0) continue;
        for (int i = 0; i < 27; ++i) {
          const int x = place[0] + i % 3 - block_width * bx,
                    y = place[1] + i / 3 % 3 - block_width * by,
                    z = place[2] + i / 9 - block_width * bz;
          if (x >= 0 && x < block_width && y >= 0 && y < block_width && z >= 0 && z < block_width)
            visit(i, static_cast<std::size_t>(block), slot_in_block(x, y, z));
        }
      }
}

void add_own_coefficients(const SplineField& field, FieldCell& cell) {
  const int l = cell.depth - coarsest_depth;
  if (l >= static_cast<int>(field.grid.levels.size())) return;
  for_active_functions(field.grid.levels[l], cell.place, [&](int i, std::size_t block, int slot) {
    cell.coefficients[i] += field.coefficients[l][block * block_size + slot];
  });
}

// One axis of the refinement: three coarse functions of a cell give the three of its half.
inline void refine_three(double a, double b, double c, int half, double out[3]) {
  if (half == 0) {
    out[0] = 0.75 * a + 0.25 * b;
    out[1] = 0.25 * a + 0.75 * b;
    out[2] = 0.75 * b + 0.25 * c;
  } else {
    out[0] = 0.25 * a + 0.75 * b;
    out[1] = 0.75 * b + 0.25 * c;
    out[2] = 0.25 * b + 0.75 * c;
  }
}

}  // namespace

FieldCell coarsest_cell(const SplineField& field, const std::array<std::int32_t, 3>& place) {
  FieldCell cell{coarsest_depth, place, {}};
  add_own_coefficients(field, cell);
  return cell;
}

FieldCell child_cell(const SplineField& field, const FieldCell& cell, int octant) {
  const int half[3] = {octant & 1, octant >> 1 & 1, octant >> 2 & 1};
  FieldCell child{cell.depth + 1, {}, cell.coefficients};
  constexpr int strides[3] = {1, 3, 9};
  for (int a = 0; a < 3; ++a) {
    child.place[a] = 2 * cell.place[a] + half[a];
    for (int line = 0; line < 9; ++line) {
      const int first = a == 0 ? 3 * line : a == 1 ? line % 3 + 9 * (line / 3) : line;
      auto& q = child.coefficients;
      const int second = first + strides[a], third = second + strides[a];
      double out[3];
      refine_three(q[first], q[second], q[third], half[a], out);
      q[first] = out[0], q[second] = out[1], q[third] = out[2];
    }
  }
  add_own_coefficients(field, child);
  return child;
}

bool has_finer_functions(const SplineField& field, const FieldCell& cell) {
  const int l = cell.depth + 1 - coarsest_depth;
  if (l >= static_cast<int>(field.grid.levels.size())) return false;
  // The children's functions.
  return field.grid.levels[l].any_active({2 * cell.place[0], 2 * cell.place[1], 2 * cell.place[2]},
                                         4);
}

FieldValue evaluate(const FieldCell& cell, const Eigen::Vector3d& in_cell) {
  const SplineWeights<double> x = spline_weights(in_cell[0]), y = spline_weights(in_cell[1]),
                              z = spline_weights(in_cell[2]);
  FieldValue f;
  for (int i = 0; i < 27; ++i) {
    const int a = i % 3, b = i / 3 % 3, c = i / 9;
    const double q = cell.coefficients[i];
    f.value += q * x.value[a] * y.value[b] * z.value[c];
    f.gradient[0] += q * x.slope[a] * y.value[b] * z.value[c];
    f.gradient[1] += q * x.value[a] * y.slope[b] * z.value[c];
    f.gradient[2] += q * x.value[a] * y.value[b] * z.slope[c];
  }
  f.gradient *= 1 << cell.depth;
  return f;
}

FieldValue evaluate(const SplineField& field, const Eigen::Vector3d& u) {
  const auto place_at = [&](int depth) {
    return std::array<std::int32_t, 3>{cell_of(u[0], 1 << depth), cell_of(u[1], 1 << depth),
                                       cell_of(u[2], 1 << depth)};
  };
  FieldCell cell = coarsest_cell(field, place_at(coarsest_depth));
  while (has_finer_functions(field, cell)) {
    const auto finer = place_at(cell.depth + 1);
    cell = child_cell(field, cell, (finer[0] & 1) | (finer[1] & 1) << 1 | (finer[2] & 1) << 2);
  }
  const Eigen::Vector3d place(cell.place[0], cell.place[1], cell.place[2]);
  return evaluate(cell, u * (1 << cell.depth) - place);
}

}  // namespace scan
