// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/blended_field.h"

#include <algorithm>
#include <cmath>

namespace scan {
namespace {

// 0 to 1 with two derivatives that vanish at either end.
double smooth_step(double t) {
  return t * t * t * (t * (6 * t - 15) + 10);
}

struct AxisShares {
  int first = 0;
  double share_of_next = 0;  // the rest is the first part's
};

AxisShares axis_shares(double x, int parts) {
  const double wall = std::round(x * parts);
  const double from_wall = x * parts - wall;  // in sides of a part
  if (wall < 1 || wall > parts - 1 || std::abs(from_wall) >= blended_share)
    return {std::clamp(static_cast<int>(std::floor(x * parts)), 0, parts - 1), 0};
  return {static_cast<int>(wall) - 1, smooth_step(0.5 + from_wall / (2 * blended_share))};
}

// The parts that may have a share in the middle of a spline on the cell, of its depth or a finer.
struct PartRange {
  std::array<int, 3> low, high;
  bool is_one() const { return low == high; }
};

PartRange parts_around(const std::array<std::int32_t, 3>& place, int depth, int split) {
  const int parts = 1 << split;
  const double sides = std::ldexp(1.0, split - depth);  // of a part, a cell is wide
  PartRange range;
  for (int a = 0; a < 3; ++a) {
    const double low = (place[a] - 0.5) * sides - blended_share;
    const double high = (place[a] + 1.5) * sides + blended_share;
    range.low[a] = std::clamp(static_cast<int>(std::floor(low)), 0, parts - 1);
    range.high[a] = std::clamp(static_cast<int>(std::floor(high)), 0, parts - 1);
  }
  return range;
}

std::vector<std::uint32_t> fields_around(const BlendedField& field,
                                         const std::array<std::int32_t, 3>& place, int depth) {
  const PartRange range = parts_around(place, depth, field.split);
  std::vector<std::uint32_t> found;
  for (int z = range.low[2]; z <= range.high[2]; ++z)
    for (int y = range.low[1]; y <= range.high[1]; ++y)
      for (int x = range.low[0]; x <= range.high[0]; ++x)
        found.push_back(field.field_of_part[x + ((y + (z << field.split)) << field.split)]);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace

PartShares shares_at(const Eigen::Vector3d& u, int split) {
  const int parts = 1 << split;
  const AxisShares axes[3] = {axis_shares(u[0], parts), axis_shares(u[1], parts),
                              axis_shares(u[2], parts)};
  PartShares shares;
  for (int i = 0; i < 8; ++i) {
    const int next[3] = {i & 1, i >> 1 & 1, i >> 2};
    double share = 1;
    for (int a = 0; a < 3; ++a)
      share *= next[a] ? axes[a].share_of_next : 1 - axes[a].share_of_next;
    if (!(share > 0)) continue;
    const int x = axes[0].first + next[0], y = axes[1].first + next[1], z = axes[2].first + next[2];
    shares.parts[shares.count++] = {static_cast<std::uint32_t>(x + ((y + (z << split)) << split)),
                                    share};
  }
  return shares;
}

BlendedCell cell_at_depth(const BlendedField& field, const std::array<std::int32_t, 3>& place,
                          int depth) {
  BlendedCell result{depth, {}};
  const auto place_at = [&](int at) {
    return std::array<std::int32_t, 3>{place[0] >> (depth - at), place[1] >> (depth - at),
                                       place[2] >> (depth - at)};
  };
  for (const std::uint32_t f : fields_around(field, place, depth)) {
    FieldCell cell = coarsest_cell(field.fields[f], place_at(coarsest_depth));
    for (int at = coarsest_depth + 1; at <= depth; ++at) {
      const auto child = place_at(at);
      cell = child_cell(field.fields[f], cell,
                        (child[0] & 1) | (child[1] & 1) << 1 | (child[2] & 1) << 2);
    }
    result.members.push_back({f, cell});
  }
  return result;
}

BlendedCell child_cell(const BlendedField& field, const BlendedCell& cell, int octant) {
  BlendedCell child{cell.depth + 1, {}};
  std::array<std::int32_t, 3> place = cell.members.front().cell.place;
  for (int a = 0; a < 3; ++a) place[a] = 2 * place[a] + (octant >> a & 1);
  if (cell.members.size() == 1) {
    const auto& [f, only] = cell.members.front();
    child.members.push_back({f, child_cell(field.fields[f], only, octant)});
    return child;
  }
  const std::vector<std::uint32_t> around = fields_around(field, place, child.depth);
  for (const auto& [f, member] : cell.members)
    if (std::binary_search(around.begin(), around.end(), f))
      child.members.push_back({f, child_cell(field.fields[f], member, octant)});
  return child;
}

FieldCell blended(const BlendedField& field, const BlendedCell& cell) {
  const FieldCell& first = cell.members.front().cell;
  // In one part shares are exactly one, so cells that do the sum hold the same bits.
  if (parts_around(first.place, cell.depth, field.split).is_one()) return first;
  FieldCell result{cell.depth, first.place, {}};
  const double width = std::ldexp(1.0, -cell.depth);
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d middle =
        width * (Eigen::Vector3d(first.place[0] + i % 3, first.place[1] + i / 3 % 3,
                                 first.place[2] + i / 9) -
                 Eigen::Vector3d::Constant(0.5));
    const PartShares shares = shares_at(middle, field.split);
    for (int k = 0; k < shares.count; ++k) {
      const std::uint32_t f = field.field_of_part[shares.parts[k].part];
      const auto member = std::find_if(cell.members.begin(), cell.members.end(),
                                       [&](const auto& m) { return m.field == f; });
      result.coefficients[i] += shares.parts[k].share * member->cell.coefficients[i];
    }
  }
  return result;
}

}  // namespace scan
