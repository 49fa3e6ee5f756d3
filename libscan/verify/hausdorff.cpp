// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/verify/hausdorff.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/search/closest_point.h"

namespace scan {
namespace {

// A part of a triangle and what of the other mesh is nearest to its corners.
struct Piece {
  std::array<Eigen::Vector3d, 3> corners;
  std::array<ClosestPoint, 3> nearest;
};

double distance_m(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& x) {
  const Triangle& t = mesh.triangles[triangle];
  return (closest_point_on_triangle(x, mesh.vertices[t[0]], mesh.vertices[t[1]],
                                    mesh.vertices[t[2]]) -
          x)
      .norm();
}

// No place of a piece is farther from its nearest corner than the longest side over the root of 3:
// in an acute triangle that is at most the radius of the circle around it, in an obtuse one less
// than half the longest side.
double upper_bound_m(const Piece& piece, const Mesh& to) {
  double longest_m = 0, farthest_m = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest_m = std::max(longest_m, (piece.corners[k] - piece.corners[(k + 1) % 3]).norm());
    farthest_m = std::max(farthest_m, piece.nearest[k].distance_m);
  }
  double bound_m = farthest_m + longest_m / std::numbers::sqrt3;
  for (const ClosestPoint& nearest : piece.nearest) {
    double to_one_m = 0;
    for (const Eigen::Vector3d& corner : piece.corners)
      to_one_m = std::max(to_one_m, distance_m(to, nearest.triangle, corner));
    bound_m = std::min(bound_m, to_one_m);
  }
  return bound_m;
}

std::vector<Piece> whole_triangles(const Mesh& from, const MeshSearch& to) {
  const auto nearest = closest_of_each(to, from.vertices);
  std::vector<Piece> pieces(from.triangles.size());
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = from.triangles[i][k];
      pieces[i].corners[k] = from.vertices[v];
      pieces[i].nearest[k] = nearest[v];
    }
  return pieces;
}

// Each piece in four, cut at the middles of its sides.
std::vector<Piece> quartered(const std::vector<Piece>& pieces, const MeshSearch& to) {
  std::vector<Eigen::Vector3d> middles;
  middles.reserve(3 * pieces.size());
  for (const Piece& piece : pieces)
    for (std::size_t k = 0; k < 3; ++k)
      middles.push_back((piece.corners[k] + piece.corners[(k + 1) % 3]) / 2);
  const auto nearest = closest_of_each(to, middles);
  std::vector<Piece> quarters;
  quarters.reserve(4 * pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto& [x, n] = pieces[i];
    const auto* m = &middles[3 * i];
    const auto* mn = &nearest[3 * i];
    for (std::size_t k = 0; k < 3; ++k)
      quarters.push_back({{x[k], m[k], m[(k + 2) % 3]}, {n[k], mn[k], mn[(k + 2) % 3]}});
    quarters.push_back({{m[0], m[1], m[2]}, {mn[0], mn[1], mn[2]}});
  }
  return quarters;
}

double farthest_corner_m(const std::vector<Piece>& pieces) {
  double farthest_m = 0;
  for (const Piece& piece : pieces)
    for (const ClosestPoint& nearest : piece.nearest)
      farthest_m = std::max(farthest_m, nearest.distance_m);
  return farthest_m;
}

void check_both(const Mesh& from, const Mesh& to) {
  check(from);
  check(to);
  if (from.empty() || to.empty()) throw Error(Trouble::input, "hausdorff: no triangles");
}

}  // namespace

Interval farthest_distance_m(const Mesh& from, const Mesh& to, const HausdorffOptions& options) {
  check_both(from, to);
  const MeshSearch search(to);
  std::vector<Piece> pieces = whole_triangles(from, search);
  Interval bounds{0, 0};
  for (std::size_t queries = from.vertices.size();;) {
    bounds.low = std::max(bounds.low, farthest_corner_m(pieces));
    const double enough_m =
        bounds.low + std::max(options.widest_share * bounds.low, options.least_m);
    std::vector<double> upper_m(pieces.size());
    parallel_for(pieces.size(), [&](std::size_t i) { upper_m[i] = upper_bound_m(pieces[i], to); });
    std::vector<Piece> open;
    double open_m = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (upper_m[i] > enough_m) {
        open.push_back(pieces[i]);
        open_m = std::max(open_m, upper_m[i]);
      } else {
        bounds.high = std::max(bounds.high, upper_m[i]);
      }
    }
    queries += 3 * open.size();
    if (open.empty() || queries > options.most_queries) {
      bounds.high = std::max({bounds.low, bounds.high, open_m});
      return bounds;
    }
    pieces = quartered(open, search);
  }
}

Interval hausdorff_m(const Mesh& a, const Mesh& b, const HausdorffOptions& options) {
  const Interval there = farthest_distance_m(a, b, options),
                 back = farthest_distance_m(b, a, options);
  return {std::max(there.low, back.low), std::max(there.high, back.high)};
}

}  // namespace scan
