// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a search keeps of the points it comes across: the answers of the three queries, decided in
// double precision. Internal to libscan/search.
//
// Each collector has `limit2_m2()`: a point farther than that cannot enter; and `offer(candidate)`:
// takes or leaves a point. Points may be offered in any order. `finish()`, once all are offered,
// puts the answer in order. The collector of one may be offered a point twice, the others may not.
#pragma once

#include <algorithm>

#include "libscan/search/neighbour_search.h"

namespace scan {

// The inclusive bound on the squared distance; negative, so that nothing is in, for a radius that
// is negative or not a number.
inline double squared_limit_m2(double radius_m) {
  return radius_m >= 0 ? radius_m * radius_m : -1;
}

class NearestCollector {
 public:
  explicit NearestCollector(double max_distance_m) : limit2_m2_(squared_limit_m2(max_distance_m)) {}
  double limit2_m2() const { return limit2_m2_; }
  void offer(const Neighbour& candidate) {
    if (!(candidate.distance2_m2 <= limit2_m2_) || (best_ && !nearer(candidate, *best_))) return;
    best_ = candidate;
    limit2_m2_ = candidate.distance2_m2;
  }
  std::optional<Neighbour> take() const { return best_; }

 private:
  double limit2_m2_;
  std::optional<Neighbour> best_;
};

// Keeps the k best in order if they are few, which is quickest, else in a heap, worst on top.
class NearestKCollector {
 public:
  NearestKCollector(std::size_t k, std::vector<Neighbour>& found) : k_(k), found_(found) {
    found_.clear();
  }
  double limit2_m2() const {
    if (k_ == 0) return -1;
    return found_.size() < k_ ? unlimited_m : worst().distance2_m2;
  }
  void offer(const Neighbour& candidate) {
    if (k_ == 0 || (found_.size() == k_ && !nearer(candidate, worst()))) return;
    k_ <= few ? insert(candidate) : push(candidate);
  }
  void finish() {
    if (k_ > few) std::sort_heap(found_.begin(), found_.end(), nearer);
  }

 private:
  static constexpr std::size_t few = 64;
  const Neighbour& worst() const { return k_ <= few ? found_.back() : found_.front(); }
  void insert(const Neighbour& candidate) {
    if (found_.size() < k_) found_.push_back(candidate);
    std::size_t place = found_.size() - 1;
    for (; place > 0 && nearer(candidate, found_[place - 1]); --place)
      found_[place] = found_[place - 1];
    found_[place] = candidate;
  }
  void push(const Neighbour& candidate) {
    if (found_.size() == k_) {
      std::pop_heap(found_.begin(), found_.end(), nearer);
      found_.pop_back();
    }
    found_.push_back(candidate);
    std::push_heap(found_.begin(), found_.end(), nearer);
  }
  std::size_t k_;
  std::vector<Neighbour>& found_;
};

class WithinCollector {
 public:
  WithinCollector(double radius_m, std::vector<Neighbour>& found)
      : limit2_m2_(squared_limit_m2(radius_m)), found_(found) {
    found_.clear();
  }
  double limit2_m2() const { return limit2_m2_; }
  void offer(const Neighbour& candidate) {
    if (candidate.distance2_m2 <= limit2_m2_) found_.push_back(candidate);
  }
  void finish() { std::sort(found_.begin(), found_.end(), nearer); }

 private:
  double limit2_m2_;
  std::vector<Neighbour>& found_;
};

}  // namespace scan
