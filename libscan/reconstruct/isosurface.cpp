// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/isosurface.h"

#include <algorithm>
#include <limits>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/crossed_cells.h"

namespace scan {
namespace {

bool owns_crossing(const CrossedCell& c, int axis) {
  return c.crossing[axis] >= 0;
}

void number_vertices(std::vector<CrossedCell>& cells, std::size_t& count) {
  count = 0;
  for (CrossedCell& c : cells) {
    c.first_vertex = static_cast<std::uint32_t>(count);
    for (int axis = 0; axis < 3; ++axis) count += owns_crossing(c, axis);
    for (int loop = 0; loop < c.polygons.loops; ++loop)
      count += needs_centre(c.polygons.sizes[loop]);
  }
}

class Polygonizer {
 public:
  Polygonizer(CrossedCells crossed, int depth)
      : cell_size_(1.0 / (1 << depth)), crossed_(std::move(crossed)) {
    number_vertices(crossed_.cells, vertices_);
  }

  Mesh mesh() const {
    const std::vector<CrossedCell>& cells = crossed_.cells;
    Mesh mesh;
    mesh.vertices.resize(vertices_);
    parallel_for(cells.size(), [&](std::size_t i) { place_vertices(cells[i], mesh); });
    std::vector<std::vector<Triangle>> parts((cells.size() + chunk - 1) / chunk);
    parallel_chunks(cells.size(), chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) add_polygons(cells[i], mesh, parts[begin / chunk]);
    });
    for (const auto& part : parts)
      mesh.triangles.insert(mesh.triangles.end(), part.begin(), part.end());
    return mesh;
  }

 private:
  static constexpr std::size_t chunk = 512;

  Eigen::Vector3d in_cube(const CrossedCell& c, const Eigen::Vector3d& in_cell) const {
    return (Eigen::Vector3d(c.place[0], c.place[1], c.place[2]) + in_cell) * cell_size_;
  }

  void place_vertices(const CrossedCell& c, Mesh& mesh) const {
    std::uint32_t vertex = c.first_vertex, centre = c.first_centre;
    for (int axis = 0; axis < 3; ++axis)
      if (owns_crossing(c, axis))
        mesh.vertices[vertex++] = in_cube(c, c.crossing[axis] * Eigen::Vector3d::Unit(axis));
    for (int loop = 0; loop < c.polygons.loops; ++loop)
      if (needs_centre(c.polygons.sizes[loop]))
        mesh.vertices[vertex++] = in_cube(c, crossed_.centres[centre++]);
  }

  std::uint32_t vertex_of(const CrossedCell& c, int edge) const {
    const int corner = edge_start_corner(edge);
    const CrossedCell* owner = &c;
    if (corner != 0) {
      CellPlace wanted = c.place;
      for (int a = 0; a < 3; ++a) wanted[a] += corner >> a & 1;
      owner = &*std::lower_bound(crossed_.cells.begin(), crossed_.cells.end(), sort_key(wanted),
                                 [](const CrossedCell& other, const CellPlace& key) {
                                   return sort_key(other.place) < key;
                                 });
    }
    std::uint32_t vertex = owner->first_vertex;
    for (int axis = 0; axis < edge / 4; ++axis) vertex += owns_crossing(*owner, axis);
    return vertex;
  }

  void add_polygons(const CrossedCell& c, const Mesh& mesh,
                    std::vector<Triangle>& triangles) const {
    std::uint32_t next_centre = c.first_vertex;
    for (int axis = 0; axis < 3; ++axis) next_centre += owns_crossing(c, axis);
    int at = 0;
    for (int k = 0; k < c.polygons.loops; ++k) {
      std::vector<std::uint32_t> loop;
      loop.reserve(c.polygons.sizes[k]);
      for (int i = 0; i < c.polygons.sizes[k]; ++i)
        loop.push_back(vertex_of(c, c.polygons.edges[at++]));
      if (needs_centre(c.polygons.sizes[k])) {
        for (std::size_t i = 0; i < loop.size(); ++i)
          triangles.push_back({loop[i], loop[(i + 1) % loop.size()], next_centre});
        ++next_centre;
      } else {
        fan(mesh, loop, triangles);
      }
    }
  }

  // A fan from the vertex with the shortest diagonals.
  void fan(const Mesh& mesh, const std::vector<std::uint32_t>& loop,
           std::vector<Triangle>& triangles) const {
    const std::size_t n = loop.size();
    const auto vertex = [&](std::size_t i) -> const Eigen::Vector3d& {
      return mesh.vertices[loop[i % n]];
    };
    std::size_t apex = 0;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n && n > 3; ++i) {
      double diagonals = 0;
      for (std::size_t j = 2; j + 1 < n; ++j) diagonals += (vertex(i + j) - vertex(i)).norm();
      if (diagonals < best) {
        best = diagonals;
        apex = i;
      }
    }
    for (std::size_t j = 1; j + 1 < n; ++j)
      triangles.push_back({loop[apex], loop[(apex + j) % n], loop[(apex + j + 1) % n]});
  }

  double cell_size_;
  CrossedCells crossed_;
  std::size_t vertices_ = 0;
};

}  // namespace

Mesh zero_level_set(const SplineField& field, int depth) {
  return Polygonizer(crossed_cells(field, depth), depth).mesh();
}

Mesh zero_level_set(const BlendedField& field, int depth) {
  return Polygonizer(crossed_cells(field, depth), depth).mesh();
}

}  // namespace scan
