// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/triangle_tree.h"

#include <emmintrin.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libscan/core/parallel.h"
#include "libscan/search/closest_point.h"

namespace scan {
namespace {

constexpr std::uint32_t leaf_bit = 0x80000000u;
constexpr std::uint32_t parallel_size = 8192;  // below, a task costs more than it saves
constexpr int halvings = 3;                    // make eight children

// Eleven levels hold 2^31 triangles, and each leaves seven children behind at most.
constexpr int most_open = 96;

std::uint32_t middle_of(std::uint32_t begin, std::uint32_t end) {
  return begin + (end - begin) / 2;
}

// Nodes of a tree of so many triangles: splits at the median make it depend on nothing else.
std::uint32_t node_count(std::uint32_t triangles, int halving = 0) {
  if (triangles == 1) return halving == 0 ? 1 : 0;
  if (halving == halvings) return node_count(triangles, 0);
  const std::uint32_t left = middle_of(0, triangles);
  return (halving == 0 ? 1 : 0) + node_count(left, halving + 1) +
         node_count(triangles - left, halving + 1);
}

// Near the mesh, in float: see LocalQuery.
class NearQuery {
 public:
  using Scalar = float;
  explicit NearQuery(const LocalQuery& query)
      : query_(query),
        at_{_mm_set1_ps(query.at[0]), _mm_set1_ps(query.at[1]), _mm_set1_ps(query.at[2])} {}
  float limit2(double limit2_m2) const { return query_.limit2(limit2_m2); }
  void box_distances2(const TriangleTree::Node& node, float* distances2) const {
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
    }
  }

 private:
  const LocalQuery& query_;
  __m128 at_[3];
};

// Far from the mesh a float knows the place of the query too poorly to tell boxes apart: in double
// the boxes' own rounding, at most sqrt(3) 2^-24, is all that blurs.
class FarQuery {
 public:
  using Scalar = double;
  FarQuery(const LocalFrame& frame, const Eigen::Vector3d& query)
      : at_((query - frame.origin_m) * frame.units_per_m), units_per_m_(frame.units_per_m) {}
  double limit2(double limit2_m2) const {
    const double limit = std::sqrt(limit2_m2) * units_per_m_ * (1 + 1e-12) + 0x1p-23;
    return limit * limit;
  }
  void box_distances2(const TriangleTree::Node& node, double* distances2) const {
    for (int i = 0; i < TriangleTree::width; ++i) {
      distances2[i] = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double below = node.low[axis][i] - at_[axis], above = at_[axis] - node.high[axis][i];
        const double gap = above > below ? above : below;
        distances2[i] += gap < 0 ? 0 : gap * gap;  // NaN stays NaN
      }
    }
  }

 private:
  Eigen::Vector3d at_;
  double units_per_m_;
};

}  // namespace

struct TriangleTree::Box {
  std::array<float, 3> low, high;
};

struct TriangleTree::Ranges {
  std::array<std::uint32_t, width + 1> first{};  // of each child; then the end of the last
  int count = 0;
};

TriangleTree::Ranges TriangleTree::split(std::vector<std::uint32_t>& order,
                                         const std::vector<Eigen::Vector3d>& centres,
                                         std::uint32_t begin, std::uint32_t end) {
  std::vector<std::uint32_t> bounds{begin, end};
  for (int halving = 0; halving < halvings; ++halving) {
    std::vector<std::uint32_t> finer{begin};
    for (std::size_t k = 0; k + 1 < bounds.size(); ++k) {
      const std::uint32_t low = bounds[k], high = bounds[k + 1];
      if (high - low > 1) {
        Bounds box;
        for (std::uint32_t i = low; i < high; ++i) box.extend(centres[order[i]]);
        Eigen::Index axis;
        box.sizes().maxCoeff(&axis);
        std::nth_element(order.begin() + low, order.begin() + middle_of(low, high),
                         order.begin() + high, [&](std::uint32_t a, std::uint32_t b) {
                           const double ca = centres[a][axis], cb = centres[b][axis];
                           return ca < cb || (ca == cb && a < b);
                         });
        finer.push_back(middle_of(low, high));
      }
      finer.push_back(high);
    }
    bounds = std::move(finer);
  }
  Ranges ranges;
  ranges.count = static_cast<int>(bounds.size()) - 1;
  std::copy(bounds.begin(), bounds.end(), ranges.first.begin());
  return ranges;
}

TriangleTree::Box TriangleTree::make_leaf(const Mesh& mesh, std::uint32_t place) {
  for (std::size_t k = 0; k < 3; ++k)
    corners_[place][k] = mesh.vertices[mesh.triangles[index_[place]][k]];
  Box box{frame_.local(corners_[place][0]), frame_.local(corners_[place][0])};
  for (const Eigen::Vector3d& corner : corners_[place]) {
    const std::array<float, 3> at = frame_.local(corner);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], at[axis]);
      box.high[axis] = std::max(box.high[axis], at[axis]);
    }
  }
  return box;
}

TriangleTree::Box TriangleTree::build(const Mesh& mesh, const std::vector<Eigen::Vector3d>& centres,
                                      std::uint32_t self, std::uint32_t begin, std::uint32_t end) {
  const Ranges ranges = split(index_, centres, begin, end);
  Node& node = nodes_[self];
  std::uint32_t next = self + 1;
  for (int k = 0; k < ranges.count; ++k) {
    const std::uint32_t size = ranges.first[k + 1] - ranges.first[k];
    node.child[k] = size == 1 ? leaf_bit | ranges.first[k] : next;
    if (size > 1) next += node_count(size);
  }
  std::array<Box, width> boxes;
  const auto build_child = [&](std::size_t k) {
    const std::uint32_t first = ranges.first[k], last = ranges.first[k + 1];
    boxes[k] = last - first == 1 ? make_leaf(mesh, first)
                                 : build(mesh, centres, node.child[k], first, last);
  };
  parallel_for(static_cast<std::size_t>(ranges.count), build_child,
               end - begin > parallel_size ? 1 : width);
  Box all = boxes[0];
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int k = 0; k < width; ++k) {
      const bool is_there = k < ranges.count;
      node.low[axis][k] = is_there ? boxes[k].low[axis] : std::numeric_limits<float>::quiet_NaN();
      node.high[axis][k] = is_there ? boxes[k].high[axis] : std::numeric_limits<float>::quiet_NaN();
      if (!is_there) continue;
      all.low[axis] = std::min(all.low[axis], boxes[k].low[axis]);
      all.high[axis] = std::max(all.high[axis], boxes[k].high[axis]);
    }
  return all;
}

TriangleTree::TriangleTree(const Mesh& mesh) : frame_(local_frame(mesh.vertices)) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<Eigen::Vector3d> centres(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    Bounds box;
    for (const std::uint32_t v : mesh.triangles[i]) box.extend(mesh.vertices[v]);
    centres[i] = box.center();
  }
  index_.resize(count);
  std::iota(index_.begin(), index_.end(), 0u);
  corners_.resize(count);
  nodes_.resize(node_count(count));
  build(mesh, centres, 0, 0, count);
  place_.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) place_[index_[i]] = i;
}

void TriangleTree::offer_place(std::uint32_t place, const Eigen::Vector3d& query,
                               Best& best) const {
  const auto& [a, b, c] = corners_[place];
  const Eigen::Vector3d point = closest_point_on_triangle(query, a, b, c);
  const double distance2 = (point - query).squaredNorm();
  const bool tie = distance2 == best.distance2_m2 && index_[place] < best.triangle;
  if (distance2 < best.distance2_m2 || tie) best = {distance2, index_[place], point};
}

void TriangleTree::offer(std::uint32_t triangle, const Eigen::Vector3d& query, Best& best) const {
  offer_place(place_[triangle], query, best);
}

// Nearest boxes first; `open` holds what is left, the nearest of each node on top.
template <class LocalQuery>
void TriangleTree::descend(const LocalQuery& local, const Eigen::Vector3d& query,
                           Best& best) const {
  using Scalar = typename LocalQuery::Scalar;
  struct Open {
    Scalar distance2;
    std::uint32_t child;
  };
  std::array<Open, most_open> open;
  int end = 0;
  open[end++] = {0, 0};
  Scalar limit2 = local.limit2(best.distance2_m2);
  while (end > 0) {
    const Open next = open[--end];
    if (next.distance2 > limit2) continue;
    if (next.child & leaf_bit) {
      const double before = best.distance2_m2;
      offer_place(next.child & ~leaf_bit, query, best);
      if (best.distance2_m2 < before) limit2 = local.limit2(best.distance2_m2);
      continue;
    }
    const Node& node = nodes_[next.child];
    alignas(16) Scalar distances2[width];
    local.box_distances2(node, distances2);
    const int begin = end;
    for (int k = 0; k < width; ++k) {
      if (!(distances2[k] <= limit2)) continue;
      int at = end++;
      for (; at > begin && open[at - 1].distance2 < distances2[k]; --at) open[at] = open[at - 1];
      open[at] = {distances2[k], node.child[k]};
    }
  }
}

void TriangleTree::search(const Eigen::Vector3d& query, Best& best) const {
  const LocalQuery local(frame_, query);
  constexpr double most_slack = 0x1p-16;  // of the mesh's size: 128 sizes away
  if (local.slack < most_slack)
    descend(NearQuery(local), query, best);
  else
    descend(FarQuery(frame_, query), query, best);
}

}  // namespace scan
