// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/choose_method.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/local_planes.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr std::size_t neighbours = 24;
constexpr double open_extent = 0.5;
// Along a rim chance leaves gaps; this many reaches (of 24 neighbours) bridge them, while points
// that look like rims by chance stay apart as long as they are fewer than some 4 in 24 * 4.
constexpr double link = 2;
// Thickness is the scatter, width some 1.4 spacings: scatter of a third of a spacing.
// Clouds with 0.1 % noise (torus, bunny) are at 0.19 and count as flat; local fits are near their
// end there: of the bunny they leave genus 3 and 100 open edges.
constexpr double flat = 0.25;
// A point is on a rim if its neighbours' mean lies off by more than this share of their reach: for
// a full disc it is 0, with a deviation of 0.5 / sqrt(24) = 0.1 per axis; for half a disc
// 4 / (3 pi) = 0.42.
constexpr double rim_offset = 0.36;

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", 100 * share);
  return text;
}

std::vector<char> points_on_rims(const PointCloud& cloud, const LocalPlanes& all) {
  std::vector<char> on_rim(cloud.size(), 0);
  parallel_for(all.neighbours == 0 ? 0 : cloud.size(), [&](std::size_t i) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t n = 0; n < all.neighbours; ++n)
      mean += cloud.points[all.around[i * all.neighbours + n]] - cloud.points[i];
    mean /= static_cast<double>(all.neighbours);
    mean -= mean.dot(all.planes[i].normal) * all.planes[i].normal;
    on_rim[i] = mean.norm() > rim_offset * all.planes[i].reach_m;
  });
  return on_rim;
}

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// The diagonal of the largest rim, a chain of points, over that of all.
double rim_extent(const PointCloud& cloud, const LocalPlanes& all,
                  const std::vector<char>& on_rim) {
  std::vector<Eigen::Vector3d> rim;
  std::vector<double> link_m;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (on_rim[i]) {
      rim.push_back(cloud.points[i]);
      link_m.push_back(link * all.planes[i].reach_m);
    }
  std::vector<std::uint32_t> parent(rim.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const KdTree tree(rim);
  std::vector<Neighbour> found;
  for (std::uint32_t i = 0; i < rim.size(); ++i) {
    tree.within(rim[i], link_m[i], found);
    for (const Neighbour& n : found) {
      const std::uint32_t a = find_root(parent, i), b = find_root(parent, n.index);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  std::map<std::uint32_t, Bounds> rims;
  for (std::uint32_t i = 0; i < rim.size(); ++i) rims[find_root(parent, i)].extend(rim[i]);
  double largest = 0;
  for (const auto& [root, box] : rims) largest = std::max(largest, box.diagonal().norm());
  return largest / bounds_of(cloud.points).diagonal().norm();
}

double median_unflatness(const LocalPlanes& all) {
  std::vector<double> ratios;
  for (const LocalPlane& plane : all.planes)
    ratios.push_back(plane.width_m > 0 ? plane.thickness_m / plane.width_m : 1);
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

}  // namespace

MethodChoice choose_method(const PreparedPoints& points) {
  const LocalPlanes planes = local_planes(points.cloud.points, neighbours);
  MethodChoice choice;
  const std::vector<char> on_rim = points_on_rims(points.cloud, planes);
  choice.rim_extent = rim_extent(points.cloud, planes, on_rim);
  choice.unflatness = median_unflatness(planes);
  const std::string rims =
      "its longest rim reaches over " + percent(choice.rim_extent) + " of its size";
  if (choice.rim_extent <= open_extent) {
    choice.reason = "the surface is closed (" + rims + "), which SSD makes most accurately";
  } else if (!points.viewpoints.empty()) {
    choice.method = ReconstructMethod::range_fusion;
    choice.reason = "the surface is open (" + rims +
                    ") and the scanners' places are known, so rays tell what is free";
  } else if (choice.unflatness < flat) {
    choice.method = ReconstructMethod::mls;
    choice.reason =
        "the surface is open (" + rims + ") and smooth, and local fits end where the samples end";
  } else {
    choice.reason = "the surface is open (" + rims + ") but too noisy for local fits";
  }
  return choice;
}

}  // namespace scan
