// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/distance_bound.h"

#include <algorithm>
#include <array>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr int most_halvings = 12;
constexpr double beyond = std::numeric_limits<double>::infinity();

struct Corner {
  Eigen::Vector3d at;
  ClosestPoint closest;
};

class Bound {
 public:
  Bound(const Mesh& to, const MeshSearch& search, double limit_m)
      : to_(to), search_(search), limit_m_(limit_m) {}

  Corner corner(const Eigen::Vector3d& at, std::uint32_t guess = no_triangle) const {
    return {at, search_.closest(at, guess)};
  }

  double of(const std::array<Corner, 3>& c, int halvings) const {
    double least = beyond;
    for (const Corner& own : c) {
      if (!(own.closest.distance_m <= limit_m_)) return beyond;
      least = std::min(least, distance_to(own.closest.triangle, c));
    }
    if (least <= limit_m_) return least;
    if (halvings == most_halvings) return beyond;
    std::array<Corner, 3> middle;
    for (int k = 0; k < 3; ++k)
      middle[k] = corner((c[k].at + c[(k + 1) % 3].at) / 2, c[k].closest.triangle);
    double largest = of({middle[0], middle[1], middle[2]}, halvings + 1);
    for (int k = 0; k < 3 && largest < beyond; ++k)
      largest = std::max(largest, of({c[k], middle[k], middle[(k + 2) % 3]}, halvings + 1));
    return largest;
  }

 private:
  double distance_to(std::uint32_t triangle, const std::array<Corner, 3>& c) const {
    const Triangle& t = to_.triangles[triangle];
    double largest = 0;
    for (const Corner& own : c)
      largest = std::max(
          largest, (own.at - closest_point_on_triangle(own.at, to_.vertices[t[0]],
                                                       to_.vertices[t[1]], to_.vertices[t[2]]))
                       .norm());
    return largest;
  }

  const Mesh& to_;
  const MeshSearch& search_;
  double limit_m_;
};

}  // namespace

std::optional<double> distance_bound(const Mesh& from, const Mesh& to, const MeshSearch& search_to,
                                     double limit_m) {
  const Bound bound(to, search_to, limit_m);
  std::vector<double> of_each(from.triangles.size());
  parallel_for(of_each.size(), [&](std::size_t i) {
    const Triangle& t = from.triangles[i];
    const Corner first = bound.corner(from.vertices[t[0]]);
    const std::uint32_t guess = first.closest.triangle;
    of_each[i] = bound.of(
        {first, bound.corner(from.vertices[t[1]], guess), bound.corner(from.vertices[t[2]], guess)},
        0);
  });
  double largest = 0;
  for (const double each : of_each) largest = std::max(largest, each);
  return largest <= limit_m ? std::optional(largest) : std::nullopt;
}

std::optional<double> two_sided_bound(const Mesh& a, const Mesh& b, double limit_m) {
  const auto there = distance_bound(a, b, MeshSearch(b), limit_m);
  if (!there) return there;
  const auto back = distance_bound(b, a, MeshSearch(a), limit_m);
  return back ? std::optional(std::max(*there, *back)) : back;
}

}  // namespace scan
