// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Spline fields of parts of the unit cube, blended into one function.
#pragma once

#include <span>

#include "libscan/reconstruct/spline_field.h"

namespace scan {

// The cube is cut into 2^split equal parts an axis, x fastest, and each part has a field. Within
// 1/16 of a part's side of a wall between two parts the one field goes over into the other: splines
// of any depth have the coefficient sum of share * coefficient, the shares taken at the middle of
// the spline. Cells that share a spline hold the same bits, so neighbours' decisions agree as they
// do in one field, and a surface has no seam.
struct BlendedField {
  int split = 0;
  std::vector<SplineField> fields;
  std::vector<std::uint32_t> field_of_part;
};

inline constexpr double blended_share = 1.0 / 16;  // of a part's side, either way of a wall

// The parts with a share at a point, at most two an axis; shares add up to one and have two
// continuous derivatives.
struct PartShare {
  std::uint32_t part = 0;
  double share = 0;
};
struct PartShares {
  std::array<PartShare, 8> parts;
  int count = 0;
};
PartShares shares_at(const Eigen::Vector3d& u, int split);

// A cell in every field that may have a share in it.
struct BlendedCell {
  struct Member {
    std::uint32_t field;
    FieldCell cell;
  };
  int depth = 0;
  std::vector<Member> members;  // ascending by field
};

// `depth` at least that of a part: parts do not cut such cells.
BlendedCell cell_at_depth(const BlendedField& field, const std::array<std::int32_t, 3>& place,
                          int depth);
BlendedCell child_cell(const BlendedField& field, const BlendedCell& cell, int octant);
FieldCell blended(const BlendedField& field, const BlendedCell& cell);

}  // namespace scan
