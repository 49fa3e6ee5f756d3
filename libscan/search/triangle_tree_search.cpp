// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How the tree of boxes is searched.
#include <emmintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "libscan/search/closest_point.h"
#include "libscan/search/triangle_tree.h"

namespace scan {
namespace {

// Ten levels of nodes hold 2^31 triangles; each leaves seven behind at most.
constexpr int most_open = 96;
constexpr std::uint32_t no_leaf = 0xffffffffu;

// Near the mesh, in float: see LocalQuery.
class NearQuery {
 public:
  using Scalar = float;
  explicit NearQuery(const LocalQuery& query)
      : query_(query),
        at_{_mm_set1_ps(query.at[0]), _mm_set1_ps(query.at[1]), _mm_set1_ps(query.at[2])} {
    query_.slack *= TriangleLeaf::leaf_slack;
  }
  float limit2(double limit2_m2) const { return query_.limit2(limit2_m2); }
  // The squared distances of the boxes; a bit for each that is within the limit.
  unsigned boxes_within(const TriangleTree::Node& node, float limit2, float* distances2) const {
    unsigned within = 0;
    for (int i = 0; i < TriangleTree::width; i += 4) {
      __m128 sum = _mm_setzero_ps();
      for (int axis = 0; axis < 3; ++axis) {
        const __m128 below = _mm_sub_ps(_mm_load_ps(node.low[axis] + i), at_[axis]);
        const __m128 above = _mm_sub_ps(at_[axis], _mm_load_ps(node.high[axis] + i));
        // Of two numbers of which one is not, max_ps returns the second: NaN boxes stay NaN.
        const __m128 gap = _mm_max_ps(_mm_max_ps(_mm_setzero_ps(), below), above);
        sum = _mm_add_ps(sum, _mm_mul_ps(gap, gap));
      }
      _mm_store_ps(distances2 + i, sum);
      const int lanes = _mm_movemask_ps(_mm_cmple_ps(sum, _mm_set1_ps(limit2)));
      within |= static_cast<unsigned>(lanes) << i;
    }
    return within;
  }
  unsigned triangles_within(const TriangleLeaf& leaf, float limit2, float* distances2) const {
    return leaf.within(at_, limit2, distances2);
  }

 private:
  LocalQuery query_;
  __m128 at_[3];
};

// Far from the mesh a float knows the place of the query too poorly to tell boxes apart: in double
// the boxes' own rounding, at most sqrt(3) 2^-24, is all that blurs. Half-spaces are not asked.
class FarQuery {
 public:
  using Scalar = double;
  FarQuery(const LocalFrame& frame, const Eigen::Vector3d& query)
      : at_((query - frame.origin_m) * frame.units_per_m), units_per_m_(frame.units_per_m) {}
  double limit2(double limit2_m2) const {
    const double limit = std::sqrt(limit2_m2) * units_per_m_ * (1 + 1e-12) + 0x1p-23;
    return limit * limit;
  }
  unsigned boxes_within(const TriangleTree::Node& node, double limit2, double* distances2) const {
    unsigned within = 0;
    for (int i = 0; i < TriangleTree::width; ++i) {
      distances2[i] = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double below = node.low[axis][i] - at_[axis], above = at_[axis] - node.high[axis][i];
        const double gap = above > below ? above : below;
        distances2[i] += gap < 0 ? 0 : gap * gap;  // NaN stays NaN
      }
      within |= static_cast<unsigned>(distances2[i] <= limit2) << i;
    }
    return within;
  }
  unsigned triangles_within(const TriangleLeaf& leaf, double, double* distances2) const {
    std::fill_n(distances2, leaf.count, 0.0);
    return (1u << leaf.count) - 1;
  }

 private:
  Eigen::Vector3d at_;
  double units_per_m_;
};

// Without a branch that depends on what is compared.
template <class Open>
Open* nearest_of(Open* begin, Open* end) {
  Open* nearest = begin;
  for (Open* other = begin + 1; other < end; ++other)
    nearest = other->distance2 < nearest->distance2 ? other : nearest;
  return nearest;
}

}  // namespace

// Makes the triangle at this place the best if it is nearer, or as near and of a lower number.
void TriangleTree::offer(std::uint32_t place, const Eigen::Vector3d& query, Best& best) const {
  const auto& [a, b, c] = corners_[place];
  const Eigen::Vector3d point = closest_point_on_triangle(query, a, b, c);
  const double distance2 = (point - query).squaredNorm();
  const bool tie = distance2 == best.distance2_m2 && index_[place] < best.triangle;
  if (distance2 < best.distance2_m2 || tie) best = {distance2, index_[place], point};
}

// Nearest bound first; nearly always the first is the nearest triangle, and shuts out the others.
template <class LocalQuery, class Scalar>
void TriangleTree::look_into(const TriangleLeaf& leaf, const LocalQuery& local,
                             const Eigen::Vector3d& query, Scalar& limit2, Best& best) const {
  alignas(16) Scalar bounds2[TriangleLeaf::width];
  unsigned left = local.triangles_within(leaf, limit2, bounds2);
  while (left != 0) {
    unsigned next = 0;
    Scalar least = limit2;
    for (unsigned rest = left; rest != 0; rest &= rest - 1) {
      const Scalar bound2 = bounds2[std::countr_zero(rest)];
      next = bound2 <= least ? rest & -rest : next;
      least = std::min(least, bound2);
    }
    if (next == 0) return;
    offer(leaf.first + static_cast<std::uint32_t>(std::countr_zero(next)), query, best);
    limit2 = local.limit2(best.distance2_m2);
    left ^= next;
  }
}

// The guess's leaf, then the others. `open` holds what is left, the nearest child of each node on
// top.
template <class LocalQuery>
TriangleTree::Best TriangleTree::descend(const LocalQuery& local, const Eigen::Vector3d& query,
                                         std::uint32_t guess) const {
  using Scalar = typename LocalQuery::Scalar;
  struct Open {
    Scalar distance2;
    std::uint32_t child;
  };
  Best best;
  Scalar limit2 = std::numeric_limits<Scalar>::infinity();
  const std::uint32_t known = guess < leaf_of_.size() ? leaf_of_[guess] : no_leaf;
  if (known != no_leaf) look_into(leaves_[known], local, query, limit2, best);
  std::array<Open, most_open> open;
  int end = 0;
  open[end++] = {0, nodes_.empty() ? leaf_bit : 0};
  alignas(16) Scalar distances2[width];
  while (end > 0) {
    const Open next = open[--end];
    if (next.distance2 > limit2) continue;
    if (next.child & leaf_bit) {
      const std::uint32_t leaf = next.child & ~leaf_bit;
      if (leaf != known) look_into(leaves_[leaf], local, query, limit2, best);
      continue;
    }
    const Node& node = nodes_[next.child];
    const int begin = end;
    for (unsigned left = local.boxes_within(node, limit2, distances2); left != 0;
         left &= left - 1) {
      const int k = std::countr_zero(left);
      open[end++] = {distances2[k], node.child[k]};
    }
    if (end > begin) std::iter_swap(nearest_of(&open[begin], &open[end]), &open[end - 1]);
  }
  return best;
}

TriangleTree::Best TriangleTree::nearest(const Eigen::Vector3d& query, std::uint32_t guess) const {
  const LocalQuery local(frame_, query);
  constexpr double most_slack = 0x1p-19;  // of the mesh's size: 16 sizes away
  return local.slack < most_slack ? descend(NearQuery(local), query, guess)
                                  : descend(FarQuery(frame_, query), query, guess);
}

}  // namespace scan
