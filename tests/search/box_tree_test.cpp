// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The trees behind KdTree and Octree, and each set of kernels that this machine can run.
#include "libscan/search/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "libscan/core/parallel.h"
#include "libscan/search/box_search.h"
#include "libscan/search/brute_force.h"
#include "tests/search/clouds.h"

namespace scan {
namespace {

using Build = BoxTree (*)(std::span<const Eigen::Vector3d>);
constexpr Build builds[] = {build_kd_tree, build_octree};

Points finite(const Points& points) {
  Points kept;
  std::copy_if(points.begin(), points.end(), std::back_inserter(kept),
               [](const auto& point) { return point.allFinite(); });
  return kept;
}

// Points, and places around them at all distances.
Points queries_for(const Points& points) {
  RandomStream random(13, 0, 0);
  Points queries;
  for (int i = 0; i < 40 && !points.empty(); ++i) {
    const Eigen::Vector3d& a = points[random.bits32() % points.size()];
    const Eigen::Vector3d& b = points[random.bits32() % points.size()];
    const double share = std::pow(10.0, -i / 4);
    queries.push_back(i % 4 == 0 ? a : Eigen::Vector3d(a + share * (b - a)));
  }
  return queries;
}

TreeQuery raw(const BoxTree& tree, const Eigen::Vector3d& query_m, double limit2_m2) {
  const LocalQuery query(tree.frame, query_m);
  return {
      {query.at[0], query.at[1], query.at[2]}, query.limit2(limit2_m2), query.widening(), nothing};
}

// All that the kernels return for a query: nearest, ten nearest, and the walk through all leaves
// within the distance of the nearest but sixty.
struct KernelAnswer {
  std::vector<std::uint32_t> nearest;
  float limit2 = 0;
  std::array<std::uint64_t, 16> best{};
  std::vector<std::uint32_t> walk;
  std::vector<std::uint32_t> in_leaves;  // of all leaves with hits: the ten nearest
  friend bool operator==(const KernelAnswer&, const KernelAnswer&) = default;
};

KernelAnswer answer(const TreeKernels& kernels, const BoxTree& tree, const Eigen::Vector3d& query_m,
                    double limit2_m2) {
  KernelAnswer of;
  const RawNearest nearest = kernels.nearest(tree.view(), raw(tree, query_m, unlimited_m));
  of.nearest.assign(nearest.places, nearest.places + std::min(nearest.count, RawNearest::kept));
  of.nearest.push_back(nearest.count);
  alignas(64) std::uint64_t best[16];
  of.limit2 = kernels.k_nearest(tree.view(), raw(tree, query_m, unlimited_m), 10, 16, best);
  std::copy(best, best + 16, of.best.begin());
  TreeWalk walk;
  std::vector<std::uint32_t> leaves;
  for (LeafHits hits{0, 1}; hits.lanes != 0;) {
    hits = kernels.next_leaf(tree.view(), raw(tree, query_m, limit2_m2), walk);
    of.walk.insert(of.walk.end(), {hits.leaf, hits.lanes});
    if (hits.lanes != 0) leaves.push_back(hits.leaf);
  }
  std::uint32_t places[most_in_patch];
  const int count = kernels.nearest_in(tree.view(), raw(tree, query_m, limit2_m2), leaves.data(),
                                       static_cast<int>(leaves.size()), 10, places);
  of.in_leaves.assign(places, places + count);
  return of;
}

double sixtieth_distance2_m2(const BruteForce& oracle, const Eigen::Vector3d& query) {
  std::vector<Neighbour> found;
  oracle.k_nearest(query, 60, found);
  return found.back().distance2_m2;
}

// Its order is that of the walk, which the next test holds.
TEST(BoxSearch, FindsTheSamePointsUnsorted) {
  for (const auto& [name, points] : hard_clouds(2000)) {
    if (finite(points).empty()) continue;
    const BruteForce oracle(points);
    for (const Build build : builds) {
      const BoxSearch search(build(points));
      for (const Eigen::Vector3d& query : queries_for(finite(points))) {
        const double radius_m = std::sqrt(sixtieth_distance2_m2(oracle, query));
        std::vector<Neighbour> sorted, unsorted;
        search.within(query, radius_m, sorted);
        search.within_unsorted(query, radius_m, unsorted);
        std::sort(unsorted.begin(), unsorted.end(), nearer);
        EXPECT_EQ(unsorted, sorted) << name;
      }
    }
  }
}

TEST(TreeKernels, ReturnTheSameBytesForEachInstructionSet) {
  const std::vector<const TreeKernels*> sets = usable_kernels();
  ASSERT_EQ(sets.back(), &sse2_kernels);
  if (sets.size() == 1) GTEST_SKIP() << "this machine has SSE2 only";
  for (const auto& [name, points] : hard_clouds(2000)) {
    if (finite(points).empty()) continue;
    const BruteForce oracle(points);
    for (const Build build : builds) {
      const BoxTree tree = build(points);
      for (const Eigen::Vector3d& query : queries_for(finite(points))) {
        const double limit2_m2 = sixtieth_distance2_m2(oracle, query);
        const KernelAnswer expected = answer(sse2_kernels, tree, query, limit2_m2);
        for (const TreeKernels* set : sets)
          EXPECT_TRUE(answer(*set, tree, query, limit2_m2) == expected)
              << name << ", " << set->instruction_set;
      }
    }
  }
}

TEST(TreeKernels, AnswerLikeBruteForceWithEachInstructionSet) {
  for (const auto& [name, points] : hard_clouds(2000)) {
    const BruteForce oracle(points);
    for (const TreeKernels* set : usable_kernels())
      for (const Build build : builds) {
        SCOPED_TRACE(name + ", " + set->instruction_set);
        BoxTree tree = build(points);
        tree.kernels = set;
        const BoxSearch search(std::move(tree));
        std::vector<Neighbour> found, expected;
        for (const Eigen::Vector3d& query : queries_for(finite(points))) {
          const std::optional<Neighbour> nearest = search.nearest(query);
          EXPECT_EQ(nearest, oracle.nearest(query));
          EXPECT_EQ(search.nearest(query, unlimited_m, 17), nearest);
          for (const std::size_t k : {2, 10, 12, 60, 61, 200}) {
            search.k_nearest(query, k, found);
            oracle.k_nearest(query, k, expected);
            EXPECT_EQ(found, expected) << "k " << k;
            search.k_nearest(query, k, found, 17);
            EXPECT_EQ(found, expected) << "k " << k << " with a guess";
          }
          const double radius_m = std::sqrt(expected.back().distance2_m2);
          search.within(query, radius_m, found);
          oracle.within(query, radius_m, expected);
          EXPECT_EQ(found, expected);
        }
        if (HasFailure()) return;
      }
  }
}

// Goes through the subtree of a child: its points lie in its box, and on their sides of the planes.
// Returns the depth.
class Inspection {
 public:
  explicit Inspection(const BoxTree& tree) : tree_(tree), seen_(tree.place_of.size(), 0) {}
  int visit(std::uint32_t child, const std::array<float, 3>& low,
            const std::array<float, 3>& high) {
    if ((child & leaf_bit) != 0) {
      visit_leaf(child & ~leaf_bit, low, high);
      return 0;
    }
    const TreeNode& node = tree_.nodes[child];
    int depth = 0;
    for (int lane = 0; lane < node_width; ++lane) {
      if (node.child[lane] == nothing) {
        EXPECT_TRUE(std::isnan(node.low[0][lane]));
        continue;
      }
      std::array<float, 3> child_low, child_high;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        child_low[axis] = node.low[axis][lane];
        child_high[axis] = node.high[axis][lane];
        EXPECT_LE(low[axis], child_low[axis]);
        EXPECT_LE(child_high[axis], high[axis]);
      }
      check_planes(node, lane);
      depth = std::max(depth, visit(node.child[lane], child_low, child_high));
    }
    return depth + 1;
  }
  const std::vector<int>& seen() const { return seen_; }

 private:
  void check_planes(const TreeNode& node, int lane) {
    for (int plane = lane + 7; plane > 0; plane = (plane - 1) / 2) {
      const bool on_or_above = plane % 2 == 0;
      const int parent = (plane - 1) / 2;
      const auto axis = node.axes >> (2 * parent) & 3u;
      if (on_or_above) {
        EXPECT_GE(node.low[axis][lane], node.plane[parent]);
      } else {
        EXPECT_LE(node.high[axis][lane], node.plane[parent]);
      }
    }
  }
  void visit_leaf(std::uint32_t leaf, const std::array<float, 3>& low,
                  const std::array<float, 3>& high) {
    for (std::uint32_t lane = 0; lane < leaf_width; ++lane) {
      if (std::isnan(tree_.leaves[leaf].at[0][lane])) continue;
      const std::uint32_t place = leaf * leaf_width + lane;
      const BoxTree::Record& record = tree_.records[place];
      EXPECT_EQ(tree_.place_of[record.index], place);
      const std::array<float, 3> at = tree_.frame.local(record.point_m);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(tree_.leaves[leaf].at[axis][lane], at[axis]);
        EXPECT_LE(low[axis], at[axis]);
        EXPECT_LE(at[axis], high[axis]);
      }
      ++seen_[record.index];
    }
  }
  const BoxTree& tree_;
  std::vector<int> seen_;
};

TEST(BoxTree, HoldsEachFinitePointOnceInItsBoxes) {
  std::vector<NamedCloud> clouds = hard_clouds(3000);
  clouds.push_back({"built by many tasks", with_holes(clustered_cloud(60000))});
  for (const auto& [name, points] : clouds)
    for (const Build build : builds) {
      SCOPED_TRACE(name);
      const BoxTree tree = build(points);
      Inspection inspection(tree);
      if (tree.points > 0) {
        EXPECT_LE(inspection.visit(tree.root, {-1, -1, -1}, {1, 1, 1}), tree_depth);
      }
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(inspection.seen()[i], points[i].allFinite() ? 1 : 0);
        EXPECT_EQ(tree.place_of[i] == nothing, !points[i].allFinite());
      }
    }
}

TEST(BoxTree, OfTheKdTreeHasFullLeaves) {
  for (const std::size_t count : {1u, 16u, 17u, 128u, 129u, 3000u})
    EXPECT_EQ(build_kd_tree(uniform_cloud(count)).leaves.size(), (count + 15) / 16);
}

TEST(BoxTree, OfTheOctreeIsDeepWhereThePointsAre) {
  const BoxTree tree = build_octree(halved_cloud(6000));
  const int depth = Inspection(tree).visit(tree.root, {-1, -1, -1}, {1, 1, 1});
  EXPECT_GT(depth, 120);
  EXPECT_LE(depth, tree_depth);
}

template <class T>
bool same_bytes(const LargeArray<T>& a, const LargeArray<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(BoxTree, IsTheSameForAnyNumberOfThreads) {
  for (const Points& points : {surface_cloud(60000), clustered_cloud(60000)})
    for (const Build build : builds) {
      std::vector<BoxTree> trees;
      for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        trees.push_back(build(points));
        EXPECT_TRUE(same_bytes(trees.back().nodes, trees.front().nodes));
        EXPECT_TRUE(same_bytes(trees.back().leaves, trees.front().leaves));
        EXPECT_EQ(trees.back().place_of, trees.front().place_of);
        EXPECT_EQ(trees.back().root, trees.front().root);
      }
    }
}

}  // namespace
}  // namespace scan
