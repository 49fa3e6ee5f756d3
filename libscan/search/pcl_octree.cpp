// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/pcl_octree.h"

#include <pcl/octree/octree_search.h>
#include <pcl/point_types.h>

#include <cmath>

#include "libscan/search/collect.h"
#include "libscan/search/local_frame.h"

// PCL is built for plain amd64; with wider alignment its classes would have another layout.
static_assert(EIGEN_MAX_ALIGN_BYTES == 16);

namespace scan {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Search = pcl::octree::OctreePointCloudSearch<pcl::PointXYZ>;

constexpr double cube_half = 2;     // in local units; PCL's upper faces do not belong to its cube
constexpr double finest = 0x1p-18;  // side of the smallest voxels
constexpr std::size_t bucket = 16;  // points beyond which a voxel is divided

pcl::PointXYZ pcl_point(const std::array<float, 3>& at) {
  return {at[0], at[1], at[2]};
}

}  // namespace

// PCL answers in float, in local units; what it finds within a radius that is wide enough for its
// rounding is decided in double.
struct PclOctree::Tree {
  LocalFrame frame;
  std::vector<Eigen::Vector3d> points_m;  // the finite ones
  std::vector<std::uint32_t> original;    // index of each in the caller's list
  std::unique_ptr<Search> search;         // none without points

  Neighbour exact(std::size_t i, const Eigen::Vector3d& query) const {
    return {original[i], squared_distance_m2(points_m[i], query)};
  }

  // PCL compares squared float distances D^2, from the query to points and to voxel centres, with
  // bounds computed in double. Rounding query and point (or centre, |centre| < 2) moves D by at
  // most sqrt(3) 2^-24 (2 + |q|) <= sqrt(3) slack (local_frame.h); computing D^2 in float, by
  // another 3 * 2^-24 D <= 3 sqrt(3) 2^-24 (2 + |q|) <= 5.2 slack. Together less than 8 slack.
  // Where that makes up a part of the cloud, its float coordinates tell nothing, and all are
  // candidates.
  template <class Collector>
  void visit(const Eigen::Vector3d& query_m, double radius_m, Collector& collector) const {
    const LocalQuery query(frame, query_m);
    const double margin = 8 * query.slack, radius = radius_m * frame.units_per_m + margin;
    if (!(radius < unlimited_m && margin < 0.25)) {
      for (std::size_t i = 0; i < points_m.size(); ++i) collector.offer(exact(i, query_m));
      return;
    }
    pcl::Indices candidates;
    std::vector<float> distances2;
    search->radiusSearch(pcl_point(query.at), radius, candidates, distances2);
    for (const auto i : candidates) collector.offer(exact(static_cast<std::size_t>(i), query_m));
  }

  // A radius that holds at least k points, if there are as many: PCL's k nearest may be wrong by
  // rounding, but any k points bound the distance of the k nearest.
  double radius_of(const Eigen::Vector3d& query_m, std::size_t k) const {
    if (k >= points_m.size()) return unlimited_m;
    pcl::Indices candidates;
    std::vector<float> distances2;
    search->nearestKSearch(pcl_point(frame.local(query_m)), static_cast<pcl::uindex_t>(k),
                           candidates, distances2);
    if (candidates.size() < k) return unlimited_m;
    double distance2 = 0;
    for (const auto i : candidates)
      distance2 = std::max(distance2, exact(static_cast<std::size_t>(i), query_m).distance2_m2);
    return std::sqrt(distance2);
  }
};

PclOctree::PclOctree(std::span<const Eigen::Vector3d> points) : tree_(std::make_unique<Tree>()) {
  tree_->frame = local_frame(points);
  auto cloud = pcl::make_shared<Cloud>();
  for (const LocalPoint& local : local_points(points, tree_->frame)) {
    cloud->push_back(pcl_point(local.at));
    tree_->points_m.push_back(points[local.index]);
    tree_->original.push_back(local.index);
  }
  if (cloud->empty()) return;
  tree_->search = std::make_unique<Search>(finest);
  tree_->search->defineBoundingBox(-cube_half, -cube_half, -cube_half, cube_half, cube_half,
                                   cube_half);
  tree_->search->enableDynamicDepth(bucket);
  tree_->search->setInputCloud(cloud);
  tree_->search->addPointsFromInputCloud();
}

PclOctree::~PclOctree() = default;
PclOctree::PclOctree(PclOctree&&) noexcept = default;
PclOctree& PclOctree::operator=(PclOctree&&) noexcept = default;

std::size_t PclOctree::size() const {
  return tree_->points_m.size();
}

std::optional<Neighbour> PclOctree::nearest(const Eigen::Vector3d& query, double max_distance_m,
                                            std::uint32_t) const {
  NearestCollector collector(max_distance_m);
  if (tree_->search && max_distance_m >= 0 && query.allFinite())
    tree_->visit(query, std::min(max_distance_m, tree_->radius_of(query, 1)), collector);
  return collector.take();
}

void PclOctree::k_nearest(const Eigen::Vector3d& query, std::size_t k,
                          std::vector<Neighbour>& found, std::uint32_t) const {
  NearestKCollector collector(k, found);
  if (tree_->search && k > 0 && query.allFinite())
    tree_->visit(query, tree_->radius_of(query, k), collector);
  collector.finish();
}

void PclOctree::within(const Eigen::Vector3d& query, double radius_m,
                       std::vector<Neighbour>& found) const {
  WithinCollector collector(radius_m, found);
  if (tree_->search && radius_m >= 0 && query.allFinite()) tree_->visit(query, radius_m, collector);
  collector.finish();
}

}  // namespace scan
