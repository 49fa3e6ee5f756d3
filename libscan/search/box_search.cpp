// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/box_search.h"

#include <bit>
#include <utility>

#include "libscan/search/box_tree.h"
#include "libscan/search/collect.h"

namespace scan {
namespace {

// Up to here the k nearest are sorted in the kernel. It keeps `spare` more at least: as long as
// not all of them rival the k-th, none that does was dropped.
constexpr std::size_t few = 60, spare = 4, insert_width = 8;

TreeQuery tree_query(const LocalQuery& query, double limit2_m2) {
  return {
      {query.at[0], query.at[1], query.at[2]}, query.limit2(limit2_m2), query.widening(), nothing};
}

Neighbour exact(const BoxTree& tree, std::size_t place, const Eigen::Vector3d& query_m) {
  const BoxTree::Record& record = tree.records[place];
  return {record.index, squared_distance_m2(record.point_m, query_m)};
}

// Offers all points within the limit, which shrinks with the collector's, each decided in double.
template <class Collector>
void offer_all(const BoxTree& tree, const LocalQuery& query, TreeQuery at, Collector& collector) {
  TreeWalk walk;
  const TreeView view = tree.view();
  for (double limit2_m2 = collector.limit2_m2();;) {
    LeafHits hits = tree.kernels->next_leaf(view, at, walk);
    if (hits.lanes == 0) return;
    for (; hits.lanes != 0; hits.lanes &= hits.lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(hits.lanes));
      collector.offer(exact(tree, std::size_t{hits.leaf} * leaf_width + lane, query.at_m));
    }
    if (collector.limit2_m2() == limit2_m2) continue;
    limit2_m2 = collector.limit2_m2();
    at.limit2 = std::min(at.limit2, query.limit2(limit2_m2));
  }
}

// The nearest point where several are as near as float can tell. `found`: one of them, or nothing.
std::optional<Neighbour> nearest_of_rivals(const BoxTree& tree, const LocalQuery& query,
                                           double max_distance_m, std::uint32_t found) {
  NearestCollector collector(max_distance_m);
  if (found != nothing) collector.offer(exact(tree, found, query.at_m));
  offer_all(tree, query, tree_query(query, collector.limit2_m2()), collector);
  return collector.take();
}

// Finds the k nearest; false if rounding leaves it open which they are. Then all of them are within
// the limit, to which `at` is narrowed.
bool find_few(const BoxTree& tree, const LocalQuery& query, TreeQuery& at, std::size_t k,
              std::vector<Neighbour>& found) {
  alignas(64) std::uint64_t best[few + spare];
  const std::size_t kept = (k + spare + insert_width - 1) / insert_width * insert_width;
  at.limit2 =
      tree.kernels->k_nearest(tree.view(), at, static_cast<int>(k), static_cast<int>(kept), best);
  const auto rivals = [&](std::uint64_t entry) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(entry >> 32)) <= at.limit2;
  };
  if (rivals(best[kept - 1])) return false;
  std::size_t count = k;
  while (rivals(best[count])) ++count;
  // First all distances, so that the processor waits for all records at once; then the order, which
  // is nearly that of the floats.
  found.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    found[i] = exact(tree, static_cast<std::uint32_t>(best[i]), query.at_m);
  for (std::size_t i = 1; i < count; ++i)
    for (std::size_t j = i; j > 0 && nearer(found[j], found[j - 1]); --j)
      std::swap(found[j], found[j - 1]);
  found.resize(k);
  return true;
}

}  // namespace

BoxSearch::BoxSearch(BoxTree&& tree) : tree_(std::make_unique<BoxTree>(std::move(tree))) {}

BoxSearch::~BoxSearch() = default;
BoxSearch::BoxSearch(BoxSearch&&) noexcept = default;
BoxSearch& BoxSearch::operator=(BoxSearch&&) noexcept = default;

std::size_t BoxSearch::size() const {
  return tree_->points;
}

std::optional<Neighbour> BoxSearch::nearest(const Eigen::Vector3d& query_m, double max_distance_m,
                                            std::uint32_t guess) const {
  const double limit2_m2 = squared_limit_m2(max_distance_m);
  if (tree_->points == 0 || !query_m.allFinite() || limit2_m2 < 0) return std::nullopt;
  const LocalQuery query(tree_->frame, query_m);
  TreeQuery at = tree_query(query, limit2_m2);
  if (guess < tree_->place_of.size() && tree_->place_of[guess] != nothing)
    at.first_leaf = tree_->place_of[guess] / leaf_width;
  const RawNearest found = tree_->kernels->nearest(tree_->view(), at);
  if (found.unsure) return nearest_of_rivals(*tree_, query, max_distance_m, found.place);
  if (found.place == nothing) return std::nullopt;
  const Neighbour neighbour = exact(*tree_, found.place, query_m);
  return neighbour.distance2_m2 <= limit2_m2 ? std::optional(neighbour) : std::nullopt;
}

void BoxSearch::k_nearest(const Eigen::Vector3d& query_m, std::size_t k,
                          std::vector<Neighbour>& found) const {
  k = std::min(k, tree_->points);
  found.clear();
  if (k == 0 || !query_m.allFinite()) return;
  const LocalQuery query(tree_->frame, query_m);
  TreeQuery at = tree_query(query, unlimited_m);
  if (k <= few && find_few(*tree_, query, at, k, found)) return;
  NearestKCollector collector(k, found);
  offer_all(*tree_, query, at, collector);
  collector.finish();
}

void BoxSearch::within(const Eigen::Vector3d& query_m, double radius_m,
                       std::vector<Neighbour>& found) const {
  WithinCollector collector(radius_m, found);
  if (tree_->points == 0 || !query_m.allFinite() || collector.limit2_m2() < 0) return;
  const LocalQuery query(tree_->frame, query_m);
  offer_all(*tree_, query, tree_query(query, collector.limit2_m2()), collector);
  collector.finish();
}

}  // namespace scan
