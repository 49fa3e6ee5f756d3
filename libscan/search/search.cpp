// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/search.h"

#include <array>
#include <utility>

namespace scan {
namespace {

constexpr std::array<std::pair<SearchMethod, std::string_view>, 5> names = {{
    {SearchMethod::kd_tree, "kd-tree"},
    {SearchMethod::octree, "octree"},
    {SearchMethod::brute_force, "brute-force"},
    {SearchMethod::flann, "flann"},
    {SearchMethod::pcl_octree, "pcl-octree"},
}};

}  // namespace

std::string_view name_of(SearchMethod method) {
  for (const auto& [candidate, name] : names)
    if (candidate == method) return name;
  return {};
}

std::optional<SearchMethod> search_method_from(std::string_view name) {
  for (const auto& [method, candidate] : names)
    if (candidate == name) return method;
  return std::nullopt;
}

AnySearch make_search(SearchMethod method, std::span<const Eigen::Vector3d> points) {
  switch (method) {
    case SearchMethod::kd_tree:
      return KdTree(points);
    case SearchMethod::octree:
      return Octree(points);
    case SearchMethod::brute_force:
      return BruteForce(points);
    case SearchMethod::flann:
      return FlannIndex(points);
    case SearchMethod::pcl_octree:
      return PclOctree(points);
  }
  return KdTree(points);  // not reached: the list above is complete
}

}  // namespace scan
