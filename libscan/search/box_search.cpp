// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/box_search.h"

#include <bit>
#include <cmath>
#include <utility>

#include "libscan/search/box_tree.h"
#include "libscan/search/collect.h"

namespace scan {
namespace {

// Up to `few`, the k nearest are sorted in the kernel. It keeps `spare` more at least: as long as
// not all of them rival the k-th, none that does was dropped. On lattices more do; then `most` are
// kept.
constexpr std::size_t few = 68, spare = 4, insert_width = 8, most = few + spare;
// Where the k-th of the point before was, how far to look for that of the next: its neighbours
// reach as far within a fifth nearly always, and half as many more would not fit.
constexpr double next_reach = 1.2;
constexpr std::size_t most_of_patch = 40;
constexpr int most_leaves_of_patch = 48;

TreeQuery tree_query(const LocalQuery& query, double limit2_m2) {
  return {
      {query.at[0], query.at[1], query.at[2]}, query.limit2(limit2_m2), query.widening(), nothing};
}

// Where a guess lies, or `nothing`.
std::uint32_t leaf_of(const BoxTree& tree, std::uint32_t guess) {
  const std::uint32_t place = guess < tree.place_of.size() ? tree.place_of[guess] : nothing;
  return place == nothing ? nothing : place / leaf_width;
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

// Sorts the first k to the front. They are nearly in order: that of the floats.
void sort_first(std::vector<Neighbour>& found, std::size_t k) {
  for (std::size_t i = 1; i < found.size(); ++i)
    for (std::size_t j = i; j > 0 && nearer(found[j], found[j - 1]); --j)
      std::swap(found[j], found[j - 1]);
  found.resize(k);
}

// Finds the k nearest; false if rounding leaves it open which they are. Then all of them are within
// the limit, to which `at` is narrowed.
bool find_few(const BoxTree& tree, const LocalQuery& query, TreeQuery& at, std::size_t k,
              std::vector<Neighbour>& found) {
  alignas(64) std::uint64_t best[most];
  const auto rivals = [&](std::uint64_t entry) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(entry >> 32)) <= at.limit2;
  };
  for (std::size_t kept = (k + spare + insert_width - 1) / insert_width * insert_width;;) {
    at.limit2 =
        tree.kernels->k_nearest(tree.view(), at, static_cast<int>(k), static_cast<int>(kept), best);
    if (!rivals(best[kept - 1])) break;
    if (kept == most) return false;
    kept = most;
  }
  std::size_t count = k;
  while (rivals(best[count])) ++count;
  // First all distances, so that the processor waits for all records at once; then the order.
  found.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    found[i] = exact(tree, static_cast<std::uint32_t>(best[i]), query.at_m);
  sort_first(found, k);
  return true;
}

// The leaves that hold all points within some reach of those of one leaf.
class Patch {
 public:
  Patch(const BoxTree& tree, std::uint32_t leaf, double reach) : tree_(tree), reach_(reach) {
    const TreeLeaf& own = tree.leaves[leaf];
    TreeQuery at{{own.at[0][0], own.at[1][0], own.at[2][0]}, 0, 0, nothing};
    double radius2 = 0;
    for (int lane = 1; lane < leaf_width && !std::isnan(own.at[0][lane]); ++lane)
      radius2 = std::max(radius2, distance2(own, lane, at));
    // Floats of squares of differences are off by at most 6 roundings of 2^-24.
    const double limit = (std::sqrt(radius2) + reach) * (1 + 0x1p-20);
    at.limit2 = static_cast<float>(std::min(limit * limit, 1e38));
    TreeWalk walk;
    const TreeView view = tree.view();
    for (LeafHits hits = tree.kernels->next_leaf(view, at, walk); hits.lanes != 0;
         hits = tree.kernels->next_leaf(view, at, walk)) {
      if (count_ == most_leaves_of_patch) {
        count_ = 0;
        return;
      }
      leaves_[count_++] = hits.leaf;
    }
  }

  // The k nearest to one of its points; false if they may lie beyond `reach`, in local units.
  bool find(const LocalQuery& query, double reach, std::size_t k,
            std::vector<Neighbour>& found) const {
    const double limit = std::min(reach, reach_);
    const TreeQuery at{{query.at[0], query.at[1], query.at[2]},
                       static_cast<float>(limit * limit),
                       query.widening(),
                       nothing};
    std::uint32_t places[most_in_patch];
    const int count =
        tree_.kernels->nearest_in(tree_.view(), at, leaves_, count_, static_cast<int>(k), places);
    if (count == 0) return false;
    found.resize(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < found.size(); ++i) found[i] = exact(tree_, places[i], query.at_m);
    sort_first(found, k);
    return true;
  }

 private:
  static double distance2(const TreeLeaf& leaf, int lane, const TreeQuery& from) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double off = double{leaf.at[axis][lane]} - double{from.at[axis]};
      sum += off * off;
    }
    return sum;
  }

  const BoxTree& tree_;
  double reach_;
  std::uint32_t leaves_[most_leaves_of_patch];
  int count_ = 0;
};

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
  at.first_leaf = leaf_of(*tree_, guess);
  const RawNearest found = tree_->kernels->nearest(tree_->view(), at);
  NearestCollector collector(max_distance_m);
  for (std::uint32_t i = 0; i < std::min(found.count, RawNearest::kept); ++i)
    collector.offer(exact(*tree_, found.places[i], query_m));
  if (found.count > RawNearest::kept)
    offer_all(*tree_, query, tree_query(query, collector.limit2_m2()), collector);
  return collector.take();
}

void BoxSearch::k_nearest(const Eigen::Vector3d& query_m, std::size_t k,
                          std::vector<Neighbour>& found, std::uint32_t guess) const {
  k = std::min(k, tree_->points);
  found.clear();
  if (k == 0 || !query_m.allFinite()) return;
  const LocalQuery query(tree_->frame, query_m);
  TreeQuery at = tree_query(query, unlimited_m);
  at.first_leaf = leaf_of(*tree_, guess);
  if (k <= few && find_few(*tree_, query, at, k, found)) return;
  NearestKCollector collector(k, found);
  offer_all(*tree_, query, at, collector);
  collector.finish();
}

std::size_t BoxSearch::patch_count() const {
  return tree_->leaves.size();
}

void BoxSearch::k_nearest_in_patch(std::size_t patch, std::size_t k, const PatchBody& body) const {
  const auto leaf = static_cast<std::uint32_t>(patch);
  k = std::min(k, tree_->points);
  std::vector<Neighbour> found;
  std::optional<Patch> leaves;
  double reach = 0;
  for (std::size_t lane = 0; lane < leaf_width; ++lane) {
    if (std::isnan(tree_->leaves[leaf].at[0][lane])) break;
    const BoxTree::Record& record = tree_->records[patch * leaf_width + lane];
    const LocalQuery query(tree_->frame, record.point_m);
    if (!leaves || !leaves->find(query, next_reach * reach, k, found))
      k_nearest(record.point_m, k, found);
    reach = std::sqrt(found.empty() ? 0 : found.back().distance2_m2) * tree_->frame.units_per_m;
    if (!leaves && k <= most_of_patch) leaves.emplace(*tree_, leaf, 2 * reach);
    body(record.index, found);
  }
}

void BoxSearch::within(const Eigen::Vector3d& query_m, double radius_m,
                       std::vector<Neighbour>& found) const {
  within_unsorted(query_m, radius_m, found);
  std::sort(found.begin(), found.end(), nearer);
}

void BoxSearch::within_unsorted(const Eigen::Vector3d& query_m, double radius_m,
                                std::vector<Neighbour>& found) const {
  WithinCollector collector(radius_m, found);
  if (tree_->points == 0 || !query_m.allFinite() || collector.limit2_m2() < 0) return;
  const LocalQuery query(tree_->frame, query_m);
  offer_all(*tree_, query, tree_query(query, collector.limit2_m2()), collector);
}

}  // namespace scan
