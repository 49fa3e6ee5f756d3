// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/octree.h"

#include <algorithm>
#include <limits>

#include "libscan/search/collect.h"
#include "libscan/search/leaf_blocks.h"

namespace scan {
namespace {

using Points = std::span<LocalPoint>;

struct Cube {
  std::array<double, 3> centre = {0, 0, 0};
  double half = 1;

  // Octant o lies above the centre on each axis whose bit is set in o.
  Cube octant(unsigned o) const {
    Cube child{centre, half / 2};
    for (unsigned axis = 0; axis < 3; ++axis)
      child.centre[axis] += (o >> axis & 1u) != 0 ? child.half : -child.half;
    return child;
  }
};

// The smallest box of some points, in local units.
struct Box {
  std::array<float, 3> low, high;

  explicit Box(std::span<const LocalPoint> points) : low(points[0].at), high(points[0].at) {
    for (const LocalPoint& point : points)
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], point.at[axis]);
        high[axis] = std::max(high[axis], point.at[axis]);
      }
  }
};

// Sorts the points by octant of the cube; returns the eight parts.
std::array<Points, 8> split(Points points, const Cube& cube) {
  std::array<Points, 8> parts;
  parts[0] = points;
  for (unsigned axis = 3; axis-- > 0;) {
    const unsigned step = 1u << axis;
    for (unsigned o = 0; o < 8; o += 2 * step) {
      const Points all = parts[o];
      const auto upper = std::partition(all.begin(), all.end(), [&](const LocalPoint& point) {
        return point.at[axis] < cube.centre[axis];
      });
      const auto below = static_cast<std::size_t>(upper - all.begin());
      parts[o] = all.first(below);
      parts[o + step] = all.subspan(below);
    }
  }
  return parts;
}

}  // namespace

// Each node knows the smallest boxes of its children's points. Cubes that hold all points of their
// parent are passed over, so the depth follows the points; a leaf holds up to `leaf_size` points,
// or any number of equal ones.
struct Octree::Tree {
  static constexpr std::size_t leaf_size = 32;
  static constexpr int width = 8;

  struct Child {
    std::uint32_t first = 0;   // the node, or the first block of a leaf
    std::uint32_t blocks = 0;  // of a leaf; 0: a node
  };
  using Eight = Eigen::Array<float, width, 1>;
  struct Node {
    std::array<Eight, 3> low, high;  // boxes of the children
    std::array<Child, width> children;
    std::uint32_t count = 0;

    Node() {
      low.fill(Eight::Zero());
      high.fill(Eight::Zero());
    }
    void add(const Box& box, Child child) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis][count] = box.low[axis];
        high[axis][count] = box.high[axis];
      }
      children[count++] = child;
    }
    // Squared distances to the boxes; those beyond `count` mean nothing.
    Eight distances2(const std::array<float, 3>& at) const {
      Eight sum = Eight::Zero();
      for (int axis = 0; axis < 3; ++axis)
        sum += (low[axis] - at[axis]).max(at[axis] - high[axis]).max(0.0f).square();
      return sum;
    }
  };

  LocalFrame frame;
  std::size_t points = 0;
  std::vector<Node> nodes;
  LeafBlocks blocks;
  Child root;

  Child build_leaf(Points part, std::span<const Eigen::Vector3d> points_m) {
    const std::size_t first = blocks.size();
    blocks.append(part, points_m);
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(blocks.size() - first)};
  }

  Child build(Points part, const Box& box, Cube cube, std::span<const Eigen::Vector3d> points_m) {
    if (part.size() <= leaf_size || box.low == box.high) return build_leaf(part, points_m);
    std::array<Points, 8> parts = split(part, cube);
    const auto holds_all = [&](const Points& p) { return p.size() == part.size(); };
    for (auto all = std::find_if(parts.begin(), parts.end(), holds_all); all != parts.end();
         all = std::find_if(parts.begin(), parts.end(), holds_all)) {
      cube = cube.octant(static_cast<unsigned>(all - parts.begin()));
      parts = split(part, cube);
    }
    const std::size_t self = nodes.size();
    nodes.emplace_back();
    for (unsigned o = 0; o < 8; ++o) {
      if (parts[o].empty()) continue;
      const Box child_box(parts[o]);
      const Child child = build(parts[o], child_box, cube.octant(o), points_m);
      nodes[self].add(child_box, child);
    }
    return {static_cast<std::uint32_t>(self), 0};
  }

  template <class Collector>
  void search(const Child& child, Screen<Collector>& screen) const {
    for (std::uint32_t i = 0; i < child.blocks; ++i) blocks.scan(child.first + i, screen);
    if (child.blocks > 0) return;
    const Node& node = nodes[child.first];
    const Eight distance2 = node.distances2(screen.at());
    std::array<std::uint32_t, width> order;  // of the children near enough, nearest first
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      if (!(distance2[i] <= screen.limit2())) continue;
      std::size_t place = count++;
      for (; place > 0 && distance2[i] < distance2[order[place - 1]]; --place)
        order[place] = order[place - 1];
      order[place] = i;
    }
    for (std::size_t i = 0; i < count && distance2[order[i]] <= screen.limit2(); ++i)
      search(node.children[order[i]], screen);
  }

  template <class Collector>
  void visit(const Eigen::Vector3d& query, Collector& collector) const {
    if (points == 0 || !query.allFinite()) return;
    Screen<Collector> screen(frame, query, collector);
    search(root, screen);
  }
};

Octree::Octree(std::span<const Eigen::Vector3d> points) : tree_(std::make_unique<Tree>()) {
  tree_->frame = local_frame(points);
  std::vector<LocalPoint> local = local_points(points, tree_->frame);
  tree_->points = local.size();
  if (local.empty()) return;
  tree_->root = tree_->build(local, Box(local), {}, points);
}

Octree::~Octree() = default;
Octree::Octree(Octree&&) noexcept = default;
Octree& Octree::operator=(Octree&&) noexcept = default;

std::size_t Octree::size() const {
  return tree_->points;
}

std::optional<Neighbour> Octree::nearest(const Eigen::Vector3d& query, double max_distance_m,
                                         std::uint32_t) const {
  NearestCollector collector(max_distance_m);
  tree_->visit(query, collector);
  return collector.take();
}

void Octree::k_nearest(const Eigen::Vector3d& query, std::size_t k,
                       std::vector<Neighbour>& found) const {
  NearestKCollector collector(k, found);
  tree_->visit(query, collector);
  collector.finish();
}

void Octree::within(const Eigen::Vector3d& query, double radius_m,
                    std::vector<Neighbour>& found) const {
  WithinCollector collector(radius_m, found);
  tree_->visit(query, collector);
  collector.finish();
}

}  // namespace scan
