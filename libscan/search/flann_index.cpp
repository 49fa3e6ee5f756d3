// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/flann_index.h"

#include <flann/flann.hpp>

#include "libscan/search/collect.h"

namespace scan {
namespace {

using Index = flann::KDTreeSingleIndex<flann::L2_Simple<double>>;

// FLANN adds up the squared distance to a box along the path from the root, one rounding of 2^-53 a
// level; and its depth is at most the 2^11 binary exponents of a double times 3 axes, as each split
// halves a side or cuts at a point. 1e-11 is more than 3 * 2^11 * 2^-53 * 4, and costs nothing.
constexpr double margin = 1 + 1e-11;

// Hands FLANN's candidates to a collector, which decides by our own squared distance.
template <class Collector>
class Bridge final : public flann::ResultSet<double> {
 public:
  Bridge(const std::vector<Eigen::Vector3d>& points, const std::vector<std::uint32_t>& original,
         const Eigen::Vector3d& query, Collector& collector)
      : points_(points), original_(original), query_(query), collector_(collector) {}
  bool full() const override { return true; }
  void addPoint(double, std::size_t i) override {
    collector_.offer({original_[i], squared_distance_m2(points_[i], query_)});
  }
  // FLANN takes what is strictly nearer than this; we want the equally near too.
  double worstDist() const override {
    const double limit2 = collector_.limit2_m2() * margin;
    return limit2 > 0 ? limit2 : std::numeric_limits<double>::denorm_min();
  }

 private:
  const std::vector<Eigen::Vector3d>& points_;
  const std::vector<std::uint32_t>& original_;
  const Eigen::Vector3d& query_;
  Collector& collector_;
};

}  // namespace

struct FlannIndex::Tree {
  std::vector<Eigen::Vector3d> points;  // the finite ones
  std::vector<std::uint32_t> original;  // index of each in the caller's list
  std::unique_ptr<Index> index;         // none without points

  template <class Collector>
  void visit(const Eigen::Vector3d& query, Collector& collector) const {
    if (!index || collector.limit2_m2() < 0 || !query.allFinite()) return;
    Bridge<Collector> bridge(points, original, query, collector);
    index->findNeighbors(bridge, query.data(), flann::SearchParams());
  }
};

FlannIndex::FlannIndex(std::span<const Eigen::Vector3d> points) : tree_(std::make_unique<Tree>()) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) continue;
    tree_->points.push_back(points[i]);
    tree_->original.push_back(static_cast<std::uint32_t>(i));
  }
  if (tree_->points.empty()) return;
  const flann::Matrix<double> rows(tree_->points.front().data(), tree_->points.size(), 3);
  tree_->index = std::make_unique<Index>(rows, flann::KDTreeSingleIndexParams(10));
  tree_->index->buildIndex();
}

FlannIndex::~FlannIndex() = default;
FlannIndex::FlannIndex(FlannIndex&&) noexcept = default;
FlannIndex& FlannIndex::operator=(FlannIndex&&) noexcept = default;

std::size_t FlannIndex::size() const {
  return tree_->points.size();
}

std::optional<Neighbour> FlannIndex::nearest(const Eigen::Vector3d& query, double max_distance_m,
                                             std::uint32_t) const {
  NearestCollector collector(max_distance_m);
  tree_->visit(query, collector);
  return collector.take();
}

void FlannIndex::k_nearest(const Eigen::Vector3d& query, std::size_t k,
                           std::vector<Neighbour>& found, std::uint32_t) const {
  NearestKCollector collector(k, found);
  tree_->visit(query, collector);
  collector.finish();
}

void FlannIndex::within(const Eigen::Vector3d& query, double radius_m,
                        std::vector<Neighbour>& found) const {
  WithinCollector collector(radius_m, found);
  tree_->visit(query, collector);
  collector.finish();
}

}  // namespace scan
