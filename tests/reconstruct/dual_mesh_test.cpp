// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/dual_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "libscan/core/error.h"
#include "libscan/reconstruct/followed_surface.h"
#include "libscan/reconstruct/reconstruct.h"
#include "tests/reconstruct/solids.h"

namespace scan {
namespace {

const Eigen::Vector3d centre(0.5, 0.5, 0.5);

double ball(const Eigen::Vector3d& u) {
  return (u - centre).norm() - 0.3;
}

double ring(const Eigen::Vector3d& u) {
  const Eigen::Vector3d x = u - centre;
  return std::hypot(std::hypot(x[0], x[1]) - 0.3, x[2]) - 0.1;
}

// A level set as the methods leave it, from seeds all over the cube.
SurfaceResult level_set(int depth, const UnitField& field) {
  std::vector<Eigen::Vector3d> seeds;
  for (int i = 0; i < 4096; ++i)
    seeds.push_back(Eigen::Vector3d(i % 16 + 0.5, i / 16 % 16 + 0.5, i / 256 + 0.5) / 16);
  SurfaceResult result;
  result.surface = followed_surface(seeds, depth, field);
  result.finest_cell_m = std::ldexp(1.0, -depth);
  return result;
}

const std::vector<Eigen::Vector3d> somewhere{centre};

void expect_dual_of(const EdgeCensus& before, const Mesh& dual) {
  const EdgeCensus census = edge_census(dual);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.non_manifold_edges, 0u);
  EXPECT_EQ(census.non_manifold_vertices, 0u);
  EXPECT_EQ(census.components, before.components);
  EXPECT_EQ(census.euler_characteristic, before.euler_characteristic);
  EXPECT_EQ(census.used_vertices, dual.vertices.size());
}

// How many quads are cut along their longer diagonal.
std::size_t cut_the_long_way(const Mesh& mesh) {
  std::size_t count = 0;
  for (std::size_t q = 0; q < mesh.quads; ++q) {
    const auto& x = mesh.vertices;
    const Triangle &first = mesh.triangles[2 * q], &second = mesh.triangles[2 * q + 1];
    count += (x[first[0]] - x[first[2]]).norm() > (x[first[1]] - x[second[2]]).norm();
  }
  return count;
}

TEST(DualMesh, IsOfQuadsAndOfTheSameTopology) {
  for (const int depth : {4, 5, 6})
    for (const auto& field : {UnitField(ball), UnitField(ring)}) {
      SurfaceResult result = level_set(depth, field);
      const EdgeCensus before = edge_census(result.surface);
      make_dual(result, somewhere);
      expect_dual_of(before, result.surface);
      EXPECT_GT(volume_m3(result.surface), 0);
      // Each root on an edge of the cells has four cells about it.
      EXPECT_EQ(2 * result.surface.quads, result.surface.triangles.size());
      EXPECT_EQ(result.support_m.size(), result.surface.vertices.size());
      EXPECT_EQ(cut_the_long_way(result.surface), 0u);
    }
}

// Random corner signs: cells with up to four pieces, pieces of up to twelve sides.
TEST(DualMesh, IsManifoldOnARandomField) {
  for (const double pitch : {1e4, 1.1e4, 1.2e4}) {
    SurfaceResult result = level_set(5, [&](const Eigen::Vector3d& u) {
      if (u.minCoeff() <= 0 || u.maxCoeff() >= 1) return 1.0;
      return std::sin(pitch * u.dot(Eigen::Vector3d(1.3, 2.7, 3.1)));
    });
    const EdgeCensus before = edge_census(result.surface);
    for (const auto& v : result.surface.vertices) result.standard_error_m.push_back(1 + v[0]);
    make_dual(result, std::vector(result.surface.vertices));
    expect_dual_of(before, result.surface);
    EXPECT_GT(result.surface.quads, result.surface.triangles.size() / 4);
    // However the planes of such pieces meet, a vertex stays in its cell, where the piece is.
    for (const double from_surface : result.support_m)
      EXPECT_LT(from_surface, std::sqrt(3) * result.finest_cell_m);
    // So does what it knows; the middle of a polygon knows what a corner of it does.
    ASSERT_EQ(result.standard_error_m.size(), result.surface.vertices.size());
    for (std::size_t v = 0; v < result.standard_error_m.size(); ++v)
      EXPECT_NEAR(result.standard_error_m[v], 1 + result.surface.vertices[v][0],
                  2 * result.finest_cell_m);
  }
}

// On a sphere of radius R tangent planes at points r from a vertex' axis meet the axis r^2 / 2 R
// above it; a piece's vertices are within 2 / sqrt(3) cells h of their mean: 0.67 h^2 / R. Corners
// of a quad are within sqrt(2) h of the root between them: its middle is at most h^2 / R below. The
// triangles, inscribed, lie on one side; the quads on both, and are nearer in the mean.
TEST(DualMesh, LiesNearerToASphereThanTheTriangles) {
  for (const int depth : {4, 5, 6}) {
    SurfaceResult result = level_set(depth, ball);
    const double h = result.finest_cell_m;
    const auto mean_miss = [&] {
      double sum = 0;
      const auto samples = sample_surface(result.surface, 20'000, 1);
      for (const auto& sample : samples) {
        sum += std::abs(ball(sample.point));
        EXPECT_LT(std::abs(ball(sample.point)), h * h / 0.3);
      }
      return sum / static_cast<double>(samples.size());
    };
    const double of_triangles = mean_miss();
    make_dual(result, somewhere);
    EXPECT_LT(mean_miss(), of_triangles);
  }
}

// A fit of few cells rounds a cube's edges off, over a cell or two, and triangles between its roots
// cut off the more. Planes whose normals are a tenth of a radian off their mean, as in such a cell,
// say where the surface bends: vertices in their meeting are nearer than roots.
TEST(DualMesh, LiesNearerToARoundedCubeThanTheTriangles) {
  const PointCloud cloud = cube_cloud(12000);
  for (const int depth : {4, 5, 6}) {
    const auto mean_miss = [&](bool quads) {
      const auto result = reconstruct(cloud, {}, {.ssd = {.depth = depth}, .quads = quads});
      double sum = 0;
      for (const auto& sample : sample_surface(result.surface, 20'000, 1))
        sum += std::abs(from_cube(sample.point));
      return sum;
    };
    EXPECT_LT(mean_miss(true), mean_miss(false)) << depth;
  }
}

// The planes of a piece beside an edge may meet in the next cell, which the surface does not cross:
// the vertex stays in its own, whose corners are on both sides.
TEST(DualMesh, HasItsVerticesInCellsThatTheSurfaceCrosses) {
  const Eigen::Matrix3d turn = exp((Vector6() << 0.3, 0.5, 0.7, 0, 0, 0).finished()).linear();
  const auto field = [&](const Eigen::Vector3d& u) {
    return (turn * (u - centre)).lpNorm<Eigen::Infinity>() - 0.25;
  };
  for (const int depth : {4, 5, 6}) {
    SurfaceResult result = level_set(depth, field);
    const double h = result.finest_cell_m;
    make_dual(result, somewhere);
    for (const Eigen::Vector3d& v : result.surface.vertices) {
      const Eigen::Vector3d low = h * (v / h).array().floor().matrix();
      int inside = 0;
      for (int corner = 0; corner < 8; ++corner)
        inside += field(low + h * Eigen::Vector3d(corner & 1, corner >> 1 & 1, corner >> 2)) < 0;
      ASSERT_TRUE(inside > 0 && inside < 8) << v.transpose();
    }
  }
}

TEST(DualMesh, EndsWhereTheSurfaceEnds) {
  SurfaceResult result = level_set(5, [](const Eigen::Vector3d& u) {
    return u[0] > 0.5 ? ball(u) : std::numeric_limits<double>::quiet_NaN();
  });
  make_dual(result, somewhere);
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_EQ(census.components, 1u);
  EXPECT_GT(census.boundary_edges, 0u);
  EXPECT_EQ(census.non_manifold_edges + census.misoriented_edges, 0u);
}

// Edges of the mesh along those of the cube, a vertex in each cell of 1.25 / 64 that they run
// through. Rounding them takes away volume (sharp_features_test.cpp); the faces are as they were.
TEST(DualMesh, HasSharpEdgesAndCorners) {
  const PointCloud cloud = cube_cloud(12'000);
  const SurfaceResult round = reconstruct(cloud, {}, {.ssd = {.depth = 6}, .quads = true});
  const SurfaceResult result =
      reconstruct(cloud, {}, {.ssd = {.depth = 6}, .sharp = true, .quads = true});
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.genus, 0);
  EXPECT_EQ(result.sharp.corners, 8u);
  const auto on_edges = std::count_if(result.surface.vertices.begin(),
                                      result.surface.vertices.end(), [](const Eigen::Vector3d& v) {
                                        Eigen::Vector3d x = v.cwiseAbs();
                                        std::sort(x.begin(), x.end());
                                        return std::abs(x[1] - 0.5) + std::abs(x[2] - 0.5) < 1e-9;
                                      });
  EXPECT_EQ(static_cast<std::size_t>(on_edges), result.sharp.edge_vertices);
  EXPECT_GE(on_edges, 12 * 50);
  EXPECT_LT(std::abs(volume_m3(result.surface) - 1), 0.1 * std::abs(volume_m3(round.surface) - 1));
}

TEST(DualMesh, KnowsWhatTheSurfaceKnew) {
  SurfaceResult result = level_set(5, ball);
  for (const auto& v : result.surface.vertices) {
    result.standard_error_m.push_back(1 + v[0]);
    result.vertex_smoothing_m.push_back(2 + v[1]);
  }
  make_dual(result, somewhere);
  ASSERT_EQ(result.standard_error_m.size(), result.surface.vertices.size());
  ASSERT_EQ(result.vertex_smoothing_m.size(), result.surface.vertices.size());
  for (std::size_t v = 0; v < result.support_m.size(); ++v) {
    EXPECT_NEAR(result.support_m[v], (result.surface.vertices[v] - centre).norm(), 1e-12);
    // The mean of places in the vertex' own cell.
    const Eigen::Vector3d& place = result.surface.vertices[v];
    EXPECT_NEAR(result.standard_error_m[v], 1 + place[0], result.finest_cell_m);
    EXPECT_NEAR(result.vertex_smoothing_m[v], 2 + place[1], result.finest_cell_m);
  }
}

// In cells of twice the size pieces of a random field touch again and again: they are split, and
// what is about a vertex is no quad, or one whose diagonal another has, too.
SurfaceResult dual_of_wide_cells(double waves) {
  SurfaceResult result = level_set(5, [&](const Eigen::Vector3d& u) {
    if (u.minCoeff() <= 0 || u.maxCoeff() >= 1) return 1.0;
    return std::sin(waves * u.dot(Eigen::Vector3d(1.3, 2.7, 3.1)));
  });
  result.finest_cell_m *= 2;
  for (const auto& v : result.surface.vertices) result.standard_error_m.push_back(1 + v[0]);
  make_dual(result, somewhere);
  return result;
}

TEST(DualMesh, IsManifoldWherePiecesTouchAgainAndAgain) {
  for (const double waves : {1e4, 1.01e4, 1.02e4, 1.03e4, 1.04e4}) {
    const EdgeCensus census = edge_census(dual_of_wide_cells(waves).surface);
    EXPECT_TRUE(census.watertight) << waves;
    EXPECT_EQ(census.non_manifold_edges + census.non_manifold_vertices, 0u) << waves;
  }
}

// A polygon's middle knows what a corner does.
TEST(DualMesh, GivesMiddlesOfPolygonsWhatACornerKnows) {
  const SurfaceResult result = dual_of_wide_cells(1e4);
  ASSERT_EQ(result.standard_error_m.size(), result.surface.vertices.size());
  std::vector<int> triangles(result.surface.vertices.size(), 0);
  for (std::size_t t = 2 * result.surface.quads; t < result.surface.triangles.size(); ++t)
    ++triangles[result.surface.triangles[t][2]];  // a middle comes last
  EXPECT_GT(std::count_if(triangles.begin(), triangles.end(), [](int n) { return n > 4; }), 100);
  for (std::size_t v = 0; v < result.standard_error_m.size(); ++v)
    EXPECT_NEAR(result.standard_error_m[v], 1 + result.surface.vertices[v][0],
                2 * result.finest_cell_m);
}

TEST(DualMesh, RefusesSurfacesThatWereNotCutOutOfCells) {
  SurfaceResult result = level_set(4, ball);
  result.finest_cell_m = 0;
  EXPECT_THROW(make_dual(result, somewhere), Error);
}

// A unit square with one corner lifted by h: its diagonals (1, 1, h) and (-1, 1, 0) are h / |(-h,
// -h, 2)| apart.
TEST(QuadWarp, IsTheDistanceOfTheDiagonals) {
  const double h = 0.3;
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, h}, {0, 1, 0}, {5, 5, 5}},
                  {{0, 1, 2}, {0, 2, 3}, {0, 1, 4}},
                  1};
  const QuadWarp warp = quad_warp(mesh);
  const double expected =
      h / std::sqrt(2 * h * h + 4) * 2 / (std::sqrt(2 + h * h) + std::sqrt(2.0));
  EXPECT_NEAR(warp.rms, expected, 1e-15);
  EXPECT_NEAR(warp.largest, expected, 1e-15);
}

}  // namespace
}  // namespace scan
