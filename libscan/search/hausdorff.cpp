// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/hausdorff.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr double beyond = std::numeric_limits<double>::infinity();
constexpr std::size_t pieces_at_once = 1 << 16;  // some 30 MB with their quarters

// A corner of a piece and what of the other mesh is nearest to it.
struct Corner {
  Eigen::Vector3d at;
  std::uint32_t triangle;
  double distance_m;
};

// A part of a triangle.
using Piece = std::array<Corner, 3>;

double distance_m(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& x) {
  const Triangle& t = mesh.triangles[triangle];
  return (closest_point_on_triangle(x, mesh.vertices[t[0]], mesh.vertices[t[1]],
                                    mesh.vertices[t[2]]) -
          x)
      .norm();
}

double lower_bound_m(const Piece& piece) {
  return std::max({piece[0].distance_m, piece[1].distance_m, piece[2].distance_m});
}

// No place of a piece is farther from its nearest corner than the longest side over the root of 3:
// in an acute triangle that is at most the radius of the circle around it, in an obtuse one less
// than half the longest side.
double upper_bound_m(const Piece& piece, const Mesh& to) {
  double longest_m = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest_m = std::max(longest_m, (piece[k].at - piece[(k + 1) % 3].at).norm());
  double bound_m = lower_bound_m(piece) + longest_m / std::numbers::sqrt3;
  for (const Corner& nearest : piece) {
    double to_one_m = 0;
    for (const Corner& corner : piece)
      to_one_m = std::max(to_one_m, distance_m(to, nearest.triangle, corner.at));
    bound_m = std::min(bound_m, to_one_m);
  }
  return bound_m;
}

// Branch and bound: pieces that may hold a farther point are cut in four. To narrow the bounds this
// goes level by level, which raises the lower one first. A limit decides each piece by itself:
// there the latest go first, so that few are kept.
class Refinement {
 public:
  Refinement(const Mesh& from, const Mesh& to, const HausdorffOptions& options)
      : from_(from), to_(to), options_(options), search_(to) {}

  DistanceBounds run() {
    std::vector<Piece> open = open_triangles();
    for (std::size_t queries = 0; !open.empty() && low_m_ <= options_.limit_m;) {
      const std::size_t count = is_limited() ? std::min(open.size(), pieces_at_once) : open.size();
      queries += 3 * count;
      if (queries > options_.most_queries) break;
      const std::vector<Piece> latest(open.end() - static_cast<std::ptrdiff_t>(count), open.end());
      open.resize(open.size() - count);
      const std::vector<Piece> quarters = open_quarters(latest);
      open.insert(open.end(), quarters.begin(), quarters.end());
    }
    if (is_limited() && (low_m_ > options_.limit_m || !open.empty())) return {low_m_, beyond};
    return {low_m_, std::max({low_m_, settled_m_, open_m_})};
  }

 private:
  bool is_limited() const { return options_.limit_m < beyond; }

  // A piece with no higher bound needs no cut.
  double enough_m() const {
    if (is_limited()) return options_.limit_m;
    return low_m_ + std::max(options_.widest_share * low_m_, options_.least_m);
  }

  template <class PieceAt>
  std::vector<Piece> open_pieces(std::size_t count, PieceAt piece_at) {
    std::vector<double> upper_m(count), lower_m(count);
    parallel_for(count, [&](std::size_t i) {
      const Piece piece = piece_at(i);
      lower_m[i] = lower_bound_m(piece);
      upper_m[i] = upper_bound_m(piece, to_);
    });
    for (const double lower : lower_m) low_m_ = std::max(low_m_, lower);
    std::vector<Piece> open;
    open_m_ = 0;
    const double settled_below_m = enough_m();
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_open = upper_m[i] > settled_below_m;
      double& highest_m = is_open ? open_m_ : settled_m_;
      highest_m = std::max(highest_m, upper_m[i]);
      if (is_open) open.push_back(piece_at(i));
    }
    return open;
  }

  std::vector<Piece> open_triangles() {
    const auto nearest = closest_of_each(search_, from_.vertices);
    const auto corner = [&](std::uint32_t v) {
      return Corner{from_.vertices[v], nearest[v].triangle, nearest[v].distance_m};
    };
    return open_pieces(from_.triangles.size(), [&](std::size_t i) {
      const Triangle& t = from_.triangles[i];
      return Piece{corner(t[0]), corner(t[1]), corner(t[2])};
    });
  }

  // Cut at the middles of the sides.
  std::vector<Piece> open_quarters(const std::vector<Piece>& pieces) {
    std::vector<Eigen::Vector3d> middles;
    middles.reserve(3 * pieces.size());
    for (const Piece& piece : pieces)
      for (std::size_t k = 0; k < 3; ++k)
        middles.push_back((piece[k].at + piece[(k + 1) % 3].at) / 2);
    const auto nearest = closest_of_each(search_, middles);
    return open_pieces(4 * pieces.size(), [&](std::size_t i) {
      const auto middle = [&](std::size_t k) {
        const std::size_t m = 3 * (i / 4) + k;
        return Corner{middles[m], nearest[m].triangle, nearest[m].distance_m};
      };
      const std::size_t k = i % 4;
      if (k == 3) return Piece{middle(0), middle(1), middle(2)};
      return Piece{pieces[i / 4][k], middle(k), middle((k + 2) % 3)};
    });
  }

  const Mesh& from_;
  const Mesh& to_;
  const HausdorffOptions& options_;
  MeshSearch search_;
  double low_m_ = 0, settled_m_ = 0, open_m_ = 0;  // highest bounds of pieces
};

void check_both(const Mesh& from, const Mesh& to) {
  check(from);
  check(to);
  if (from.empty() || to.empty()) throw Error(Trouble::input, "hausdorff: no triangles");
}

}  // namespace

DistanceBounds farthest_distance(const Mesh& from, const Mesh& to,
                                 const HausdorffOptions& options) {
  check_both(from, to);
  return Refinement(from, to, options).run();
}

DistanceBounds hausdorff_distance(const Mesh& a, const Mesh& b, const HausdorffOptions& options) {
  const DistanceBounds there = farthest_distance(a, b, options);
  if (there.low_m > options.limit_m) return there;
  const DistanceBounds back = farthest_distance(b, a, options);
  return {std::max(there.low_m, back.low_m), std::max(there.high_m, back.high_m)};
}

}  // namespace scan
