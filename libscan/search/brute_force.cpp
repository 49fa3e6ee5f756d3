// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/brute_force.h"

#include "libscan/search/collect.h"

namespace scan {

struct BruteForce::Tree {
  std::vector<Eigen::Vector3d> points;  // the finite ones
  std::vector<std::uint32_t> index;     // the original index of each

  template <class Collector>
  void visit(const Eigen::Vector3d& query, Collector& collector) const {
    if (!query.allFinite()) return;
    for (std::size_t i = 0; i < points.size(); ++i)
      collector.offer({index[i], squared_distance_m2(points[i], query)});
  }
};

BruteForce::BruteForce(std::span<const Eigen::Vector3d> points) : tree_(std::make_unique<Tree>()) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) continue;
    tree_->points.push_back(points[i]);
    tree_->index.push_back(static_cast<std::uint32_t>(i));
  }
}

BruteForce::~BruteForce() = default;
BruteForce::BruteForce(BruteForce&&) noexcept = default;
BruteForce& BruteForce::operator=(BruteForce&&) noexcept = default;

std::size_t BruteForce::size() const {
  return tree_->points.size();
}

std::optional<Neighbour> BruteForce::nearest(const Eigen::Vector3d& query, double max_distance_m,
                                             std::uint32_t) const {
  NearestCollector collector(max_distance_m);
  tree_->visit(query, collector);
  return collector.take();
}

void BruteForce::k_nearest(const Eigen::Vector3d& query, std::size_t k,
                           std::vector<Neighbour>& found, std::uint32_t) const {
  // By sorting all, not by the collector of the other models, for which this is the oracle.
  found.clear();
  if (!query.allFinite()) return;
  for (std::size_t i = 0; i < tree_->points.size(); ++i)
    found.push_back({tree_->index[i], squared_distance_m2(tree_->points[i], query)});
  const std::size_t kept = std::min(k, found.size());
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept), found.end(),
                    nearer);
  found.resize(kept);
}

void BruteForce::within(const Eigen::Vector3d& query, double radius_m,
                        std::vector<Neighbour>& found) const {
  WithinCollector collector(radius_m, found);
  tree_->visit(query, collector);
  collector.finish();
}

}  // namespace scan
