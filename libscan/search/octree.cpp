// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Meagher's octree (Computer Graphics and Image Processing 19, 1982) with leaves of up to sixteen
// points. Cubes that hold all points of their parent are passed over, and a half or a quarter of a
// cube that fits into a leaf is not divided further, so the tree follows the points.
#include "libscan/search/octree.h"

#include <algorithm>

#include "libscan/core/parallel.h"
#include "libscan/search/box_tree.h"

namespace scan {
namespace {

using Points = std::span<LocalPoint>;

constexpr std::size_t parallel_points = 8192;  // below, a task costs more than it saves

// Sides are halved from 2 on. Different floats below 1 differ by 2^-149 at least, so 151 levels of
// nodes part them; equal points need another 10, as 2^32 of them fill 8^10 leaves.
static_assert(tree_depth >= 151 + 10);

struct Cube {
  std::array<float, 3> centre = {0, 0, 0};
  float half = 1;

  // Octant o lies on or above the centre on each axis whose bit is set in o.
  Cube octant(unsigned o) const {
    Cube child{centre, half / 2};
    for (unsigned axis = 0; axis < 3; ++axis)
      child.centre[axis] += (o >> axis & 1u) != 0 ? child.half : -child.half;
    return child;
  }
};

struct Child {
  Points points;
  unsigned lane;
  Cube cube;
};

// The children of one node.
struct Division {
  TreeNode node = empty_node();
  std::array<Child, node_width> children;
  std::size_t count = 0;

  // Divides the cube.
  Division(Points points, const Cube& cube) { divide(points, cube, 0, node_width, 0); }
  // Divides equal points into runs that fill all leaves but the last; the planes touch all.
  explicit Division(Points points) {
    std::fill_n(node.plane, node_width - 1, points[0].at[0]);
    std::size_t run = leaf_width;
    while (run * node_width < points.size()) run *= node_width;
    for (; !points.empty(); points = points.subspan(std::min(run, points.size()))) {
      children[count] = {
          points.first(std::min(run, points.size())), static_cast<unsigned>(count), {}};
      ++count;
    }
  }

 private:
  void divide(Points part, const Cube& cube, unsigned lane, unsigned width, unsigned plane) {
    if (part.empty()) return;
    if (width == 1 || part.size() <= leaf_width) {
      children[count++] = {part, lane, cube.octant(lane)};
      return;
    }
    const unsigned half = width / 2, axis = half / 2;  // 4, 2, 1: z, y, x
    const auto upper = std::partition(part.begin(), part.end(), [&](const LocalPoint& point) {
      return point.at[axis] < cube.centre[axis];
    });
    const auto below = static_cast<std::size_t>(upper - part.begin());
    node.plane[plane] = cube.centre[axis];
    node.axes |= axis << (2 * plane);
    divide(part.first(below), cube, lane, half, 2 * plane + 1);
    divide(part.subspan(below), cube, lane + half, half, 2 * plane + 2);
  }
};

Division division_of(Points points, const TreeBox& box, Cube cube) {
  if (box.low == box.high) return Division(points);
  Division division(points, cube);
  while (division.count == 1) {
    cube = division.children[0].cube;
    division = Division(points, cube);
  }
  return division;
}

// A part of the tree, with nodes and leaves numbered within it.
struct Branch {
  std::vector<TreeNode> nodes;
  std::vector<Points> leaves;

  // Adds the tree of the points; returns its root as a child.
  std::uint32_t add(Points points, const TreeBox& box, const Cube& cube) {
    if (points.size() <= leaf_width) {
      leaves.push_back(points);
      return leaf_bit | static_cast<std::uint32_t>(leaves.size() - 1);
    }
    Division division = division_of(points, box, cube);
    const std::size_t self = nodes.size();
    nodes.emplace_back();
    const auto add_to = [](Branch& branch, const Child& child, TreeNode& node) {
      const TreeBox child_box(child.points);
      set_child(node, child.lane, branch.add(child.points, child_box, child.cube), child_box);
    };
    if (points.size() <= parallel_points) {
      for (std::size_t i = 0; i < division.count; ++i)
        add_to(*this, division.children[i], division.node);
    } else {
      std::array<Branch, node_width> branches;
      parallel_for(
          division.count,
          [&](std::size_t i) { add_to(branches[i], division.children[i], division.node); }, 1);
      for (std::size_t i = 0; i < division.count; ++i)
        append(branches[i], division.node.child[division.children[i].lane]);
    }
    nodes[self] = division.node;
    return static_cast<std::uint32_t>(self);
  }

 private:
  // Numbers the branch's nodes and leaves, and its root, behind our own.
  void append(const Branch& branch, std::uint32_t& root) {
    const auto first_node = static_cast<std::uint32_t>(nodes.size());
    const auto first_leaf = static_cast<std::uint32_t>(leaves.size());
    const auto renumber = [&](std::uint32_t& child) {
      if (child != nothing) child += (child & leaf_bit) != 0 ? first_leaf : first_node;
    };
    renumber(root);
    nodes.insert(nodes.end(), branch.nodes.begin(), branch.nodes.end());
    for (std::size_t i = first_node; i < nodes.size(); ++i)
      for (std::uint32_t& child : nodes[i].child) renumber(child);
    leaves.insert(leaves.end(), branch.leaves.begin(), branch.leaves.end());
  }
};

}  // namespace

BoxTree build_octree(std::span<const Eigen::Vector3d> points_m) {
  BoxTree tree = empty_tree(points_m);
  LargeArray<LocalPoint> local = local_points(points_m, tree.frame);
  tree.points = local.size();
  if (local.empty()) return tree;
  Branch branch;
  tree.root = branch.add(local, TreeBox(local), {});
  tree.nodes.assign(branch.nodes.begin(), branch.nodes.end());
  tree.resize(branch.leaves.size());
  parallel_for(branch.leaves.size(), [&](std::size_t i) {
    tree.fill(static_cast<std::uint32_t>(i), branch.leaves[i], points_m);
  });
  return tree;
}

Octree::Octree(std::span<const Eigen::Vector3d> points) : BoxSearch(build_octree(points)) {}

}  // namespace scan
