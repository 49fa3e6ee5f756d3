// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How the tree of boxes is built.
#include "libscan/search/triangle_tree.h"

#include <algorithm>
#include <numeric>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::uint32_t parallel_size = 8192;  // below, a task costs more than it saves
constexpr int halvings = 3;                    // make eight children

std::uint32_t middle_of(std::uint32_t begin, std::uint32_t end) {
  return begin + (end - begin) / 2;
}

struct TreeSize {
  std::uint32_t nodes = 0, leaves = 0;
};

// Of a tree of so many triangles: splits at the median make it depend on nothing else.
TreeSize size_of(std::uint32_t triangles, int halving = 0) {
  if (triangles <= TriangleLeaf::width) return {0, 1};
  if (halving == halvings) return size_of(triangles);
  const std::uint32_t half = middle_of(0, triangles);
  const TreeSize left = size_of(half, halving + 1), right = size_of(triangles - half, halving + 1);
  return {left.nodes + right.nodes + (halving == 0 ? 1 : 0), left.leaves + right.leaves};
}

}  // namespace

struct TriangleTree::Box {
  std::array<float, 3> low, high;
};

struct TriangleTree::Ranges {
  std::array<std::uint32_t, width + 1> first{};  // of each child; then the end of the last
  int count = 0;
};

// The triangles from `begin` to `end` in leaf order, and where their first node and leaf stand.
struct TriangleTree::Part {
  std::uint32_t begin, end;
  std::uint32_t node = 0, leaf = 0;
  std::uint32_t size() const { return end - begin; }
  bool is_leaf() const { return size() <= TriangleLeaf::width; }
};

TriangleTree::Ranges TriangleTree::split(std::vector<std::uint32_t>& order,
                                         const std::vector<Eigen::Vector3d>& centres,
                                         std::uint32_t begin, std::uint32_t end) {
  std::vector<std::uint32_t> bounds{begin, end};
  for (int halving = 0; halving < halvings; ++halving) {
    std::vector<std::uint32_t> finer{begin};
    for (std::size_t k = 0; k + 1 < bounds.size(); ++k) {
      const std::uint32_t low = bounds[k], high = bounds[k + 1];
      if (high - low > TriangleLeaf::width) {
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

TriangleTree::Box TriangleTree::make_leaf(const Mesh& mesh, const Part& part) {
  constexpr float most = std::numeric_limits<float>::max();
  Box box{{most, most, most}, {-most, -most, -most}};
  TriangleLeaf& leaf = leaves_[part.leaf];
  leaf = {};
  leaf.first = part.begin;
  leaf.count = part.size();
  for (std::uint32_t place = part.begin; place < part.end; ++place) {
    std::array<Eigen::Vector3d, 3> local;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& corner = mesh.vertices[mesh.triangles[index_[place]][k]];
      corners_[place][k] = corner;
      local[k] = (corner - frame_.origin_m) * frame_.units_per_m;
      const std::array<float, 3> at = frame_.local(corner);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], at[axis]);
        box.high[axis] = std::max(box.high[axis], at[axis]);
      }
    }
    leaf.set(static_cast<int>(place - part.begin), local);
    leaf_of_[index_[place]] = part.leaf;
  }
  return box;
}

TriangleTree::Box TriangleTree::build(const Mesh& mesh, const std::vector<Eigen::Vector3d>& centres,
                                      const Part& part) {
  return part.is_leaf() ? make_leaf(mesh, part) : build_node(mesh, centres, part);
}

TriangleTree::Box TriangleTree::build_node(const Mesh& mesh,
                                           const std::vector<Eigen::Vector3d>& centres,
                                           const Part& part) {
  const Ranges ranges = split(index_, centres, part.begin, part.end);
  Node& node = nodes_[part.node];
  std::array<Part, width> parts;
  Part next{.begin = 0, .end = 0, .node = part.node + 1, .leaf = part.leaf};
  for (std::size_t k = 0; k < static_cast<std::size_t>(ranges.count); ++k) {
    parts[k] = {ranges.first[k], ranges.first[k + 1], next.node, next.leaf};
    node.child[k] = parts[k].is_leaf() ? leaf_bit | next.leaf : next.node;
    const TreeSize size = size_of(parts[k].size());
    next.node += size.nodes;
    next.leaf += size.leaves;
  }
  std::array<Box, width> boxes;
  const auto build_child = [&](std::size_t k) { boxes[k] = build(mesh, centres, parts[k]); };
  parallel_for(static_cast<std::size_t>(ranges.count), build_child,
               part.size() > parallel_size ? 1 : width);
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
  nodes_.resize(size_of(count).nodes);
  leaves_.resize(size_of(count).leaves);
  leaf_of_.resize(count);
  build(mesh, centres, {0, count});
}

}  // namespace scan
