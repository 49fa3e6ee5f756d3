// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The solved function: its value and gradient anywhere, and its walk from coarse to fine cells.
#pragma once

#include <optional>

#include "libscan/reconstruct/spline_levels.h"

namespace scan {

// References: must live as long.
struct SplineField {
  const OctreeGrid& grid;
  const LevelArrays& coefficients;
};

// A cell of any depth with the 27 coefficients that give the function there, in the splines of that
// depth, finer levels of the field left out. They are sums in a fixed order: two cells that share a
// function hold the same bits, which keeps neighbouring cells' decisions equal.
struct FieldCell {
  int depth = 0;
  std::array<std::int32_t, 3> place{};  // in cells of this depth
  std::array<double, 27> coefficients{};
};

FieldCell coarsest_cell(const SplineField& field);  // the whole unit cube
// `octant`: bits x, y, z.
FieldCell child_cell(const SplineField& field, const FieldCell& cell, int octant);
// Whether a finer level has functions on the cell.
bool has_finer_functions(const SplineField& field, const FieldCell& cell);

struct FieldValue {
  double value = 0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};
// In unit-cube coordinates, `in_cell` in [0, 1]^3 of the cell.
FieldValue evaluate(const FieldCell& cell, const Eigen::Vector3d& in_cell);
// At a point of the unit cube, all levels counted.
FieldValue evaluate(const SplineField& field, const Eigen::Vector3d& u);

}  // namespace scan
