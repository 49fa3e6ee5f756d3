// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/patches.h"

#include <gtest/gtest.h>

#include "libscan/search/box_tree.h"
#include "libscan/search/search.h"
#include "tests/search/clouds.h"

namespace scan {
namespace {

using Lists = std::vector<std::vector<Neighbour>>;  // of each point

Lists one_by_one(const Points& points, std::size_t k) {
  const BruteForce oracle(points);
  Lists lists(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].allFinite()) oracle.k_nearest(points[i], k, lists[i]);
  return lists;
}

template <class S>
Lists by_patches(const S& search, const Points& points, std::size_t k) {
  Lists lists(points.size());
  k_nearest_of_own(search, points, k, [&](std::uint32_t i, std::vector<Neighbour>& found) {
    EXPECT_TRUE(lists[i].empty()) << "asked twice: " << i;
    lists[i] = found;
  });
  return lists;
}

TEST(Patches, AnswerLikeBruteForceWithEachInstructionSet) {
  for (const auto& [name, points] : hard_clouds(500))
    for (const std::size_t k : {2, 16, 41}) {
      const Lists expected = one_by_one(points, k);
      for (const TreeKernels* set : usable_kernels())
        for (const auto build : {build_kd_tree, build_octree}) {
          BoxTree tree = build(points);
          tree.kernels = set;
          EXPECT_EQ(by_patches(BoxSearch(std::move(tree)), points, k), expected)
              << name << ", " << set->instruction_set << ", k " << k;
        }
    }
}

TEST(Patches, AreOptional) {
  const Points points = with_holes(surface_cloud(300));
  const Lists expected = one_by_one(points, 5);
  for (const SearchMethod method : {SearchMethod::brute_force, SearchMethod::flann,
                                    SearchMethod::pcl_octree, SearchMethod::kd_tree})
    std::visit(
        [&](const auto& search) {
          EXPECT_EQ(by_patches(search, points, 5), expected) << name_of(method);
        },
        make_search(method, points));
}

const TreeKernels* real_kernels;
int whole_walks;
float count_walks(const TreeView& view, const TreeQuery& at, int k, int capacity,
                  std::uint64_t* best) {
  ++whole_walks;
  return real_kernels->k_nearest(view, at, k, capacity, best);
}

// Else a patch would do no better than single queries. One point in sixteen begins a patch.
TEST(Patches, RarelyWalkThroughTheWholeTree) {
  const Points points = surface_cloud(5000);
  BoxTree tree = build_kd_tree(points);
  real_kernels = tree.kernels;
  TreeKernels counting = *real_kernels;
  counting.k_nearest = count_walks;
  tree.kernels = &counting;
  const BoxSearch search(std::move(tree));
  whole_walks = 0;
  for (std::size_t patch = 0; patch < search.patch_count(); ++patch)
    search.k_nearest_in_patch(patch, 16, [](std::uint32_t, std::vector<Neighbour>&) {});
  EXPECT_GE(whole_walks, 5000 / 16);
  EXPECT_LT(whole_walks, 5000 / 5);
}

}  // namespace
}  // namespace scan
