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
  float distance2(const std::array<float, 3>& from) const {
    float sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float gap = std::max(std::max(low[axis] - from[axis], from[axis] - high[axis]), 0.0f);
      sum += gap * gap;
    }
    return sum;
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

// Each node knows the smallest box of its points. Cubes that hold all points of their parent are
// passed over, so the depth follows the points; a leaf holds up to `leaf_size` points, or any
// number of equal ones.
struct Octree::Tree {
  static constexpr std::size_t leaf_size = 16;
  struct Node {
    Box box;
    std::uint32_t first = 0;       // child node, or block of a leaf
    std::uint32_t count : 31 = 0;  // of children, or of blocks
    std::uint32_t is_leaf : 1 = 0;
  };
  LocalFrame frame;
  std::size_t points = 0;
  std::vector<Node> nodes;
  LeafBlocks blocks;

  void build_leaf(std::size_t self, Points part, std::span<const Eigen::Vector3d> points_m) {
    nodes[self].first = static_cast<std::uint32_t>(blocks.size());
    blocks.append(part, points_m);
    nodes[self].count = static_cast<std::uint32_t>(blocks.size()) - nodes[self].first;
    nodes[self].is_leaf = 1;
  }

  void build(std::size_t self, Points part, Cube cube, std::span<const Eigen::Vector3d> points_m) {
    const Box box = nodes[self].box;
    if (part.size() <= leaf_size || box.low == box.high) return build_leaf(self, part, points_m);
    std::array<Points, 8> parts = split(part, cube);
    const auto holds_all = [&](const Points& p) { return p.size() == part.size(); };
    for (auto all = std::find_if(parts.begin(), parts.end(), holds_all); all != parts.end();
         all = std::find_if(parts.begin(), parts.end(), holds_all)) {
      cube = cube.octant(static_cast<unsigned>(all - parts.begin()));
      parts = split(part, cube);
    }
    const std::size_t first = nodes.size();
    for (const Points& child : parts)
      if (!child.empty()) nodes.push_back({Box(child)});
    nodes[self].first = static_cast<std::uint32_t>(first);
    nodes[self].count = static_cast<std::uint32_t>(nodes.size() - first);
    std::size_t next = first;
    for (unsigned o = 0; o < 8; ++o)
      if (!parts[o].empty()) build(next++, parts[o], cube.octant(o), points_m);
  }

  template <class Collector>
  void search(const Node& node, Screen<Collector>& screen) const {
    if (node.is_leaf != 0) {
      for (std::uint32_t i = 0; i < node.count; ++i) blocks.scan(node.first + i, screen);
      return;
    }
    std::array<std::pair<float, std::uint32_t>, 8> children;  // nearest first
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const float distance2 = nodes[node.first + i].box.distance2(screen.at());
      if (!(distance2 <= screen.limit2())) continue;
      std::size_t place = count++;
      for (; place > 0 && distance2 < children[place - 1].first; --place)
        children[place] = children[place - 1];
      children[place] = {distance2, node.first + i};
    }
    for (std::size_t i = 0; i < count && children[i].first <= screen.limit2(); ++i)
      search(nodes[children[i].second], screen);
  }

  template <class Collector>
  void visit(const Eigen::Vector3d& query, Collector& collector) const {
    if (nodes.empty()) return;
    Screen<Collector> screen(frame, query, collector);
    search(nodes.front(), screen);
  }
};

Octree::Octree(std::span<const Eigen::Vector3d> points) : tree_(std::make_unique<Tree>()) {
  tree_->frame = local_frame(points);
  std::vector<LocalPoint> local = local_points(points, tree_->frame);
  tree_->points = local.size();
  if (local.empty()) return;
  tree_->nodes.push_back({Box(local)});
  tree_->build(0, local, {}, points);
}

Octree::~Octree() = default;
Octree::Octree(Octree&&) noexcept = default;
Octree& Octree::operator=(Octree&&) noexcept = default;

std::size_t Octree::size() const {
  return tree_->points;
}

std::optional<Neighbour> Octree::nearest(const Eigen::Vector3d& query,
                                         double max_distance_m) const {
  NearestCollector collector(max_distance_m);
  tree_->visit(query, collector);
  return collector.take();
}

void Octree::k_nearest(const Eigen::Vector3d& query, std::size_t k,
                       std::vector<Neighbour>& found) const {
  NearestKCollector collector(k, found);
  tree_->visit(query, collector);
}

void Octree::within(const Eigen::Vector3d& query, double radius_m,
                    std::vector<Neighbour>& found) const {
  WithinCollector collector(radius_m, found);
  tree_->visit(query, collector);
  collector.finish();
}

}  // namespace scan
