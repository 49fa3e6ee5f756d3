// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/crossed_cells.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr double snap_guard = 5e-4;

// Value at a corner: the mean of its eight functions' coefficients, summed in the functions' order.
double corner_value(const FieldCell& cell, int corner) {
  const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
  double sum = 0;
  for (int c = 0; c < 2; ++c)
    for (int b = 0; b < 2; ++b)
      for (int a = 0; a < 2; ++a) sum += cell.coefficients[x + a + 3 * (y + b) + 9 * (z + c)];
  return sum / 8;
}

std::array<double, 8> corner_values(const FieldCell& cell) {
  std::array<double, 8> values;
  const int last = 1 << cell.depth;
  for (int corner = 0; corner < 8; ++corner) {
    values[corner] = corner_value(cell, corner);
    for (int a = 0; a < 3; ++a) {
      const int at = cell.place[a] + (corner >> a & 1);
      if (at == 0 || at == last) values[corner] = std::abs(values[corner]);
    }
  }
  return values;
}

bool may_hold_zero(const FieldCell& cell) {
  const auto [low, high] = std::minmax_element(cell.coefficients.begin(), cell.coefficients.end());
  if (*low >= 0) return false;
  if (*high >= 0) return true;
  const int last = (1 << cell.depth) - 1;
  for (const int at : cell.place)
    if (at == 0 || at == last) return true;  // the wall counts as outside
  return false;
}

// Root of the parabola with spline coefficients q along a cell one of whose ends counts as inside.
// Where the parabola does not change its sign, the end that was judged otherwise is on a wall, or
// on the level set to rounding: there the crossing is.
double parabola_root(const std::array<double, 3>& q, bool start_inside) {
  const double start = (q[0] + q[1]) / 2, slope = q[1] - q[0], bend = (q[0] - 2 * q[1] + q[2]) / 2;
  const double end = (q[1] + q[2]) / 2;
  if ((start < 0) == (end < 0)) return (start < 0) != start_inside ? 0 : 1;
  // start + slope t + bend t^2 = 0 without cancellation; the one root between the ends, past one of
  // them by rounding where the function vanishes there.
  const double root = std::sqrt(std::max(0.0, slope * slope - 4 * bend * start));
  const double sum = -(slope + std::copysign(root, slope)) / 2;
  const double first = sum / bend, second = start / sum;
  return std::abs(first - 0.5) < std::abs(second - 0.5) ? first : second;
}

// Where the function vanishes along an edge of the cell, as a share of the edge.
double edge_parameter(const FieldCell& cell, const std::array<double, 8>& corners, int edge) {
  constexpr int strides[3] = {1, 3, 9};
  const int axis = edge / 4, corner = edge_start_corner(edge);
  const int start = (corner & 1) + 3 * (corner >> 1 & 1) + 9 * (corner >> 2);
  const int u = strides[(axis + 1) % 3], v = strides[(axis + 2) % 3];
  std::array<double, 3> q;
  for (int i = 0; i < 3; ++i) {
    const double* at = cell.coefficients.data() + start + i * strides[axis];
    q[i] = (at[0] + at[u] + at[v] + at[u + v]) / 4;
  }
  const double t = parabola_root(q, corners[corner] < 0);
  return std::isfinite(t) ? std::clamp(t, snap_guard, 1 - snap_guard) : 0.5;
}

// The mean of a loop, moved along the gradient to the level set as long as it stays in the cell.
Eigen::Vector3d loop_centre(const FieldCell& cell, const std::array<double, 8>& corners,
                            const signed char* edges, int size) {
  Eigen::Vector3d in_cell = Eigen::Vector3d::Zero();
  for (int i = 0; i < size; ++i) {
    const int corner = edge_start_corner(edges[i]);
    in_cell += Eigen::Vector3d(corner & 1, corner >> 1 & 1, corner >> 2) +
               edge_parameter(cell, corners, edges[i]) * Eigen::Vector3d::Unit(edges[i] / 4);
  }
  in_cell /= size;
  for (int step = 0; step < 5; ++step) {
    const FieldValue f = evaluate(cell, in_cell);
    const double slope2 = f.gradient.squaredNorm();
    if (!(slope2 > 0)) break;
    const Eigen::Vector3d moved = in_cell - f.value / slope2 * f.gradient * (1 << cell.depth);
    if (moved.minCoeff() < snap_guard || moved.maxCoeff() > 1 - snap_guard) break;
    in_cell = moved;
  }
  return in_cell;
}

void add_crossed(const FieldCell& cell, const std::array<double, 8>& corners, CrossedCells& out) {
  CrossedCell crossed{.place = cell.place, .polygons = cell_polygons(corners), .crossing = {}};
  for (int axis = 0; axis < 3; ++axis) {
    const bool crosses = (corners[0] < 0) != (corners[1 << axis] < 0);
    crossed.crossing[axis] = crosses ? edge_parameter(cell, corners, 4 * axis) : -1;
  }
  crossed.first_centre = static_cast<std::uint32_t>(out.centres.size());
  const signed char* edges = crossed.polygons.edges.data();
  for (int loop = 0; loop < crossed.polygons.loops; edges += crossed.polygons.sizes[loop++])
    if (needs_centre(crossed.polygons.sizes[loop]))
      out.centres.push_back(loop_centre(cell, corners, edges, crossed.polygons.sizes[loop]));
  out.cells.push_back(crossed);
}

constexpr int task_depth = 4;  // cells of this depth are walked in parallel

bool is_empty(const SplineField& field, const FieldCell& cell) {
  return !may_hold_zero(cell) && !has_finer_functions(field, cell);
}

// Shares are not negative: where all fields have the same sign, so has their blend.
bool is_empty(const BlendedField& field, const BlendedCell& cell) {
  const bool inside = cell.members.front().cell.coefficients[0] < 0;
  return std::all_of(cell.members.begin(), cell.members.end(), [&](const auto& member) {
    return (member.cell.coefficients[0] < 0) == inside &&
           is_empty(field.fields[member.field], member.cell);
  });
}

FieldCell blended(const SplineField&, const FieldCell& cell) {
  return cell;
}

template <class Field, class Cell>
void collect_crossed(const Field& field, const Cell& cell, int depth, CrossedCells& crossed) {
  if (cell.depth == depth) {
    const FieldCell here = blended(field, cell);
    if (!may_hold_zero(here)) return;
    const std::array<double, 8> values = corner_values(here);
    const auto inside = std::count_if(values.begin(), values.end(), [](double v) { return v < 0; });
    if (inside > 0 && inside < 8) add_crossed(here, values, crossed);
    return;
  }
  if (is_empty(field, cell)) return;
  for (int octant = 0; octant < 8; ++octant)
    collect_crossed(field, child_cell(field, cell, octant), depth, crossed);
}

void collect_tasks(const SplineField& field, const FieldCell& cell, int depth,
                   std::vector<FieldCell>& tasks) {
  if (cell.depth == depth)
    tasks.push_back(cell);
  else if (!is_empty(field, cell))
    for (int octant = 0; octant < 8; ++octant)
      collect_tasks(field, child_cell(field, cell, octant), depth, tasks);
}

std::vector<FieldCell> tasks_of(const SplineField& field, int depth) {
  std::vector<FieldCell> tasks;
  constexpr int side = 1 << coarsest_depth;
  for (int i = 0; i < side * side * side; ++i)
    collect_tasks(field, coarsest_cell(field, {i % side, i / side % side, i / side / side}),
                  std::min(depth, task_depth), tasks);
  return tasks;
}

std::vector<BlendedCell> tasks_of(const BlendedField& field, int depth) {
  const int at = std::min(depth, std::max(task_depth, field.split));
  const int side = 1 << at;
  std::vector<BlendedCell> tasks;
  for (int i = 0; i < side * side * side; ++i) {
    BlendedCell task = cell_at_depth(field, {i % side, i / side % side, i / side / side}, at);
    if (!is_empty(field, task)) tasks.push_back(std::move(task));
  }
  return tasks;
}

// Parts come in the order of their tasks.
CrossedCells joined(std::vector<CrossedCells>& parts) {
  std::size_t count = 0;
  for (const CrossedCells& part : parts) count += part.cells.size();
  CrossedCells all;
  all.cells.reserve(count);
  for (CrossedCells& part : parts) {
    for (CrossedCell& cell : part.cells) {
      cell.first_centre += static_cast<std::uint32_t>(all.centres.size());
      all.cells.push_back(cell);
    }
    all.centres.insert(all.centres.end(), part.centres.begin(), part.centres.end());
    part = {};
  }
  std::sort(all.cells.begin(), all.cells.end(), [](const CrossedCell& a, const CrossedCell& b) {
    return sort_key(a.place) < sort_key(b.place);
  });
  return all;
}

template <class Field>
CrossedCells walk(const Field& field, int depth) {
  const auto tasks = tasks_of(field, depth);
  std::vector<CrossedCells> parts(tasks.size());
  parallel_for(
      tasks.size(), [&](std::size_t i) { collect_crossed(field, tasks[i], depth, parts[i]); }, 4);
  return joined(parts);
}

}  // namespace

CrossedCells crossed_cells(const SplineField& field, int depth) {
  return walk(field, depth);
}

CrossedCells crossed_cells(const BlendedField& field, int depth) {
  return walk(field, depth);
}

}  // namespace scan
