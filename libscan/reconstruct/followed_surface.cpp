// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/followed_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/cell_polygons.h"

namespace scan {
namespace {

using Place = std::array<std::int32_t, 3>;

constexpr int deepest = 20;
constexpr double root_tolerance = 1e-5;  // of the larger value at an edge's ends
constexpr int most_steps = 20;
constexpr double snap_guard = 5e-4;  // vertices keep this share of an edge off its ends

// Corners per axis, both walls' among them: three such digits and an edge's axis fit into 64 bits,
// where 21 bits a digit would not.
constexpr std::uint64_t most_corners = (1u << deepest) + 1;

std::uint64_t key_of(const Place& p) {
  return std::uint64_t(p[0]) +
         most_corners * (std::uint64_t(p[1]) + most_corners * std::uint64_t(p[2]));
}

Place place_of(std::uint64_t key) {
  const std::uint64_t rows = key / most_corners;
  return {std::int32_t(key % most_corners), std::int32_t(rows % most_corners),
          std::int32_t(rows / most_corners)};
}

Place corner_of(Place cell, int corner) {
  for (int a = 0; a < 3; ++a) cell[a] += corner >> a & 1;
  return cell;
}

void sort_unique(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

struct CrossedCell {
  std::uint64_t key;
  std::array<double, 8> values;
};

class Follower {
 public:
  Follower(int depth, const UnitField& field, std::size_t most_cells)
      : field_(field), cells_((1 << depth)), most_cells_(most_cells) {}

  // Most seeds lie in a cell that is crossed, or beside one: the cells around others alone are
  // looked into, since each corner costs a value of the field.
  void follow(std::span<const Eigen::Vector3d> seeds) {
    follow_from(cells_of(seeds, [](const Place& cell) { return std::vector(1, cell); }));
    std::unordered_set<std::uint64_t> crossed;
    for (const CrossedCell& cell : crossed_) crossed.insert(cell.key);
    follow_from(cells_of(seeds, [&](const Place& cell) {
      std::vector<Place> around = cells_about(cell);
      const bool is_near = std::any_of(around.begin(), around.end(), [&](const Place& place) {
        return is_inside(place) && crossed.contains(key_of(place));
      });
      return is_near ? std::vector<Place>{} : around;
    }));
    std::sort(crossed_.begin(), crossed_.end(),
              [](const CrossedCell& a, const CrossedCell& b) { return a.key < b.key; });
  }

  Mesh mesh() const;

 private:
  Eigen::Vector3d at(const Place& corner) const {
    return Eigen::Vector3d(corner[0], corner[1], corner[2]) / cells_;
  }

  void follow_from(std::vector<std::uint64_t> front) {
    while (!front.empty()) {
      evaluate_corners(front);
      std::vector<std::uint64_t> next;
      for (const std::uint64_t cell : front) visit(cell, next);
      sort_unique(next);
      std::erase_if(next, [&](std::uint64_t key) { return !seen_.insert(key).second; });
      front = std::move(next);
    }
  }

  static std::vector<Place> cells_about(const Place& cell) {
    std::vector<Place> about;
    for (int i = 0; i < 27; ++i)
      about.push_back({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1});
    return about;
  }

  // New ones among those that `of_cell` names for the seeds' own.
  template <class OfCell>
  std::vector<std::uint64_t> cells_of(std::span<const Eigen::Vector3d> seeds, OfCell of_cell) {
    std::vector<std::uint64_t> keys;
    for (const auto& seed : seeds) {
      Place own;
      for (int a = 0; a < 3; ++a) own[a] = static_cast<std::int32_t>(std::floor(seed[a] * cells_));
      for (const Place& place : of_cell(own))
        if (is_inside(place)) keys.push_back(key_of(place));
    }
    sort_unique(keys);
    std::erase_if(keys, [&](std::uint64_t key) { return !seen_.insert(key).second; });
    return keys;
  }

  bool is_inside(const Place& cell) const {
    return std::all_of(cell.begin(), cell.end(), [&](int x) { return x >= 0 && x < cells_; });
  }

  void evaluate_corners(const std::vector<std::uint64_t>& front) {
    std::vector<std::uint64_t> wanted;
    for (const std::uint64_t cell : front)
      for (int corner = 0; corner < 8; ++corner) {
        const std::uint64_t key = key_of(corner_of(place_of(cell), corner));
        if (!values_.contains(key)) wanted.push_back(key);
      }
    sort_unique(wanted);
    std::vector<double> found(wanted.size());
    parallel_for(wanted.size(), [&](std::size_t i) { found[i] = field_(at(place_of(wanted[i]))); });
    for (std::size_t i = 0; i < wanted.size(); ++i) values_.emplace(wanted[i], found[i]);
  }

  void visit(std::uint64_t key, std::vector<std::uint64_t>& next) {
    const Place cell = place_of(key);
    std::array<double, 8> values;
    int inside = 0;
    for (int corner = 0; corner < 8; ++corner) {
      values[corner] = values_.at(key_of(corner_of(cell, corner)));
      if (!std::isfinite(values[corner])) return;
      inside += values[corner] < 0;
    }
    if (inside == 0 || inside == 8) return;
    if (crossed_.size() == most_cells_)
      throw Error(Trouble::resource, "surface: more than " + std::to_string(most_cells_) + " cells",
                  "use a smaller depth");
    crossed_.push_back({key, values});
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        int inside_face = 0;
        for (int corner = 0; corner < 8; ++corner)
          inside_face += (corner >> axis & 1) == side && values[corner] < 0;
        Place neighbour = cell;
        neighbour[axis] += side == 1 ? 1 : -1;
        if (inside_face > 0 && inside_face < 4 && is_inside(neighbour))
          next.push_back(key_of(neighbour));
      }
  }

  // Edges by the key of their lower corner, then the axis.
  static std::uint64_t edge_key(const Place& corner, int axis) { return key_of(corner) * 4 + axis; }

  Eigen::Vector3d root_on(std::uint64_t edge) const;
  Eigen::Vector3d onto_surface(const Eigen::Vector3d& u) const;

  const UnitField& field_;
  std::int32_t cells_;
  std::size_t most_cells_;
  std::unordered_set<std::uint64_t> seen_;
  std::unordered_map<std::uint64_t, double> values_;
  std::vector<CrossedCell> crossed_;
};

// Regula falsi with the Illinois rule; an unknown value between known ends leaves the chord's root.
Eigen::Vector3d Follower::root_on(std::uint64_t edge) const {
  const Place low = place_of(edge / 4);
  const auto axis = static_cast<int>(edge % 4);
  Place high = low;
  ++high[axis];
  double a = 0, b = 1, fa = values_.at(key_of(low)), fb = values_.at(key_of(high));
  const Eigen::Vector3d start = at(low), step = Eigen::Vector3d::Unit(axis) / cells_;
  double t = fa / (fa - fb);
  const double small = root_tolerance * std::max(std::abs(fa), std::abs(fb));
  for (int i = 0; i < most_steps; ++i) {
    const double f = field_(start + t * step);
    if (!std::isfinite(f) || std::abs(f) <= small) break;
    if ((f < 0) == (fa < 0)) {
      a = t;
      fa = f;
      fb /= 2;
    } else {
      b = t;
      fb = f;
      fa /= 2;
    }
    t = a + (b - a) * fa / (fa - fb);
  }
  return start + std::clamp(t, snap_guard, 1 - snap_guard) * step;
}

// Newton steps along the gradient by differences; stays if the field is unknown or the way long.
Eigen::Vector3d Follower::onto_surface(const Eigen::Vector3d& u) const {
  const double h = 1e-3 / cells_;
  Eigen::Vector3d at = u;
  for (int i = 0; i < 3; ++i) {
    const double f = field_(at);
    Eigen::Vector3d gradient;
    for (int a = 0; a < 3; ++a) gradient[a] = (field_(at + h * Eigen::Vector3d::Unit(a)) - f) / h;
    const Eigen::Vector3d next = at - f / gradient.squaredNorm() * gradient;
    if (!next.allFinite() || (next - u).norm() > 0.4 / cells_) return u;
    at = next;
  }
  return at;
}

struct Loop {
  std::array<std::uint32_t, 12> vertices;
  int size;
};

// A fan from the vertex with the shortest diagonals; long loops get a vertex in their middle, since
// their diagonals may lie in a face, where a neighbour could have the same one.
void add_loop(const Loop& loop, Mesh& mesh, std::vector<std::uint32_t>& centres) {
  const int n = loop.size;
  const auto vertex = [&](int i) { return loop.vertices[i % n]; };
  if (n > 5) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < n; ++i) sum += mesh.vertices[vertex(i)];
    const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(sum / n);
    centres.push_back(centre);
    for (int i = 0; i < n; ++i) mesh.triangles.push_back({vertex(i), vertex(i + 1), centre});
    return;
  }
  int apex = 0;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < n; ++i) {
    double diagonals = 0;
    for (int j = 2; j + 1 < n; ++j)
      diagonals += (mesh.vertices[vertex(i + j)] - mesh.vertices[vertex(i)]).norm();
    if (diagonals < best) {
      best = diagonals;
      apex = i;
    }
  }
  for (int j = 1; j + 1 < n; ++j)
    mesh.triangles.push_back({vertex(apex), vertex(apex + j), vertex(apex + j + 1)});
}

Mesh Follower::mesh() const {
  std::vector<std::uint64_t> edges;
  for (const CrossedCell& cell : crossed_) {
    const CellPolygons polygons = cell_polygons(cell.values);
    for (int i = 0, loop = 0; loop < polygons.loops; i += polygons.sizes[loop++])
      for (int k = i; k < i + polygons.sizes[loop]; ++k)
        edges.push_back(
            edge_key(corner_of(place_of(cell.key), edge_start_corner(polygons.edges[k])),
                     polygons.edges[k] / 4));
  }
  sort_unique(edges);
  Mesh mesh;
  mesh.vertices.resize(edges.size());
  parallel_for(edges.size(), [&](std::size_t i) { mesh.vertices[i] = root_on(edges[i]); });
  std::vector<std::uint32_t> centres;
  for (const CrossedCell& cell : crossed_) {
    const CellPolygons polygons = cell_polygons(cell.values);
    for (int at_edge = 0, k = 0; k < polygons.loops; ++k) {
      Loop loop{{}, polygons.sizes[k]};
      for (int i = 0; i < loop.size; ++i, ++at_edge) {
        const int edge = polygons.edges[at_edge];
        const std::uint64_t key =
            edge_key(corner_of(place_of(cell.key), edge_start_corner(edge)), edge / 4);
        loop.vertices[i] = static_cast<std::uint32_t>(
            std::lower_bound(edges.begin(), edges.end(), key) - edges.begin());
      }
      add_loop(loop, mesh, centres);
    }
  }
  parallel_for(centres.size(), [&](std::size_t i) {
    mesh.vertices[centres[i]] = onto_surface(mesh.vertices[centres[i]]);
  });
  return mesh;
}

}  // namespace

Mesh followed_surface(std::span<const Eigen::Vector3d> seeds, int depth, const UnitField& field,
                      std::size_t most_cells) {
  if (depth < 0 || depth > deepest)
    throw Error(Trouble::usage, "surface: depth is " + std::to_string(depth) + ", limits 0 and 20");
  Follower follower(depth, field, most_cells);
  follower.follow(seeds);
  return follower.mesh();
}

}  // namespace scan
