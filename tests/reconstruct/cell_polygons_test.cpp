// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/cell_polygons.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <set>

#include "libscan/core/random.h"

namespace scan {
namespace {

std::array<double, 8> values_of(int inside_mask, RandomStream& random) {
  std::array<double, 8> values;
  for (int c = 0; c < 8; ++c)
    values[c] = (inside_mask >> c & 1 ? -1 : 1) * (0.1 + random.uniform());
  return values;
}

Eigen::Vector3d middle_of(int edge) {
  const int c = edge_start_corner(edge);
  return Eigen::Vector3d(c & 1, c >> 1 & 1, c >> 2) + 0.5 * Eigen::Vector3d::Unit(edge / 4);
}

TEST(CellPolygons, UseEachCrossedEdgeOnce) {
  RandomStream random(1, 0, 0);
  for (int mask = 0; mask < 256; ++mask) {
    const auto values = values_of(mask, random);
    std::set<int> crossed, used;
    for (int e = 0; e < 12; ++e) {
      const int a = edge_start_corner(e), b = a | 1 << e / 4;
      if ((values[a] < 0) != (values[b] < 0)) crossed.insert(e);
    }
    const CellPolygons polygons = cell_polygons(values);
    int at = 0;
    for (int k = 0; k < polygons.loops; ++k) {
      EXPECT_GE(polygons.sizes[k], 3);
      for (int i = 0; i < polygons.sizes[k]; ++i)
        EXPECT_TRUE(used.insert(polygons.edges[at++]).second);
    }
    EXPECT_EQ(used, crossed) << "corners " << mask;
  }
}

// Mirrored at x = 1 the cube has a neighbour with the same four values on the common face: both
// must join its crossings by the same segments, in opposite directions.
TEST(CellPolygons, AgreeOnACommonFace) {
  RandomStream random(2, 0, 0);
  for (int mask = 0; mask < 4096; ++mask) {
    const auto left = values_of(mask & 255, random);
    auto right = values_of(0, random);
    for (int c = 0; c < 8; ++c) {
      if (!(c & 1)) right[c] = left[c | 1];
      if (c & 1) right[c] *= (mask >> (8 + (c >> 1)) & 1) ? -1 : 1;
    }
    std::set<std::pair<int, int>> of_left, of_right;
    const auto segments = [](const CellPolygons& p, int face_bit, bool reversed, auto& found) {
      const auto on_face = [&](int e) {
        return e / 4 != 0 && (edge_start_corner(e) & 1) == face_bit;
      };
      const auto name = [](int e) { return e / 4 * 8 + edge_start_corner(e) / 2; };
      int begin = 0;
      for (int k = 0; k < p.loops; begin += p.sizes[k++])
        for (int i = 0; i < p.sizes[k]; ++i) {
          const int a = p.edges[begin + i], b = p.edges[begin + (i + 1) % p.sizes[k]];
          if (!on_face(a) || !on_face(b)) continue;
          found.insert(reversed ? std::pair(name(b), name(a)) : std::pair(name(a), name(b)));
        }
    };
    segments(cell_polygons(left), 1, false, of_left);
    segments(cell_polygons(right), 0, true, of_right);
    EXPECT_EQ(of_left, of_right) << "corners " << mask;
  }
}

TEST(CellPolygons, TurnTheirNormalOutwards) {
  for (int corner = 0; corner < 8; ++corner) {
    std::array<double, 8> values;
    values.fill(1);
    values[corner] = -1;
    const CellPolygons p = cell_polygons(values);
    ASSERT_EQ(p.loops, 1);
    ASSERT_EQ(p.sizes[0], 3);
    const Eigen::Vector3d a = middle_of(p.edges[0]), b = middle_of(p.edges[1]),
                          c = middle_of(p.edges[2]);
    const Eigen::Vector3d inside(corner & 1, corner >> 1 & 1, corner >> 2);
    EXPECT_GT((b - a).cross(c - a).dot(a - inside), 0) << "corner " << corner;
  }
}

// Corners 0 and 3 inside on the face z = 0, and nothing else: joined if their product is greater.
TEST(CellPolygons, JoinAcrossAFaceAsItsSaddleSays) {
  std::array<double, 8> values;
  values.fill(10);
  values[0] = values[3] = -1;
  values[1] = values[2] = 2;
  EXPECT_EQ(cell_polygons(values).loops, 2);  // saddle (1 - 4) / (-6) = +0.5: outside between them
  values[1] = values[2] = 0.5;
  EXPECT_EQ(cell_polygons(values).loops, 1);
}

}  // namespace
}  // namespace scan
