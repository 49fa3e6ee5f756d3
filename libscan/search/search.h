// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The choice among the neighbour searches at run time.
#pragma once

#include <string_view>
#include <variant>

#include "libscan/search/brute_force.h"
#include "libscan/search/flann_index.h"
#include "libscan/search/kd_tree.h"
#include "libscan/search/neighbour_search.h"
#include "libscan/search/octree.h"
#include "libscan/search/pcl_octree.h"

namespace scan {

enum class SearchMethod { kd_tree, octree, brute_force, flann, pcl_octree };

// "kd-tree", "octree", "brute-force", "flann", "pcl-octree"; and back (none for another word).
std::string_view name_of(SearchMethod method);
std::optional<SearchMethod> search_method_from(std::string_view name);

using AnySearch = std::variant<KdTree, Octree, BruteForce, FlannIndex, PclOctree>;

// Builds the structure over a copy of the points (metres).
AnySearch make_search(SearchMethod method, std::span<const Eigen::Vector3d> points);

}  // namespace scan
