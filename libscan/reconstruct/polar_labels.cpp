// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/polar_labels.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace scan {
namespace {

// What is known of a ball: how surely it is inside, and outside.
struct Belief {
  double inside = 0, outside = 0;
  bool is_settled = false;
  // Those with one answer first, by certainty; then those with two, by how far apart these are.
  double urgency() const {
    if (inside > 0 && outside > 0) return std::abs(inside - outside) - 1;
    return std::max(inside, outside);
  }
};

class Labelling {
 public:
  Labelling(std::size_t balls, std::span<const PolarTie> ties) : ties_(ties), of_ball_(balls) {
    for (std::uint32_t t = 0; t < ties.size(); ++t)
      if (ties[t].certainty > 0) {
        of_ball_[ties[t].first].push_back(t);
        of_ball_[ties[t].second].push_back(t);
      }
    beliefs_.resize(balls);
    is_inside_.assign(balls, 0);
  }

  bool is_settled(std::uint32_t ball) const { return beliefs_[ball].is_settled; }
  bool is_inside(std::uint32_t ball) const { return is_inside_[ball]; }
  std::vector<char> all() const { return is_inside_; }

  void tell(std::uint32_t ball, bool is_inside, double certainty) {
    Belief& belief = beliefs_[ball];
    double& side = is_inside ? belief.inside : belief.outside;
    if (belief.is_settled || !(certainty > side)) return;
    side = certainty;
    queue_.push({belief.urgency(), ball});
  }

  void settle() {
    while (!queue_.empty()) {
      const auto [urgency, ball] = queue_.top();
      queue_.pop();
      Belief& belief = beliefs_[ball];
      if (belief.is_settled || urgency != belief.urgency()) continue;
      belief.is_settled = true;
      is_inside_[ball] = belief.inside > belief.outside;
      const double known = std::max(belief.inside, belief.outside);
      for (const std::uint32_t t : of_ball_[ball]) {
        const PolarTie& tie = ties_[t];
        tell(tie.first == ball ? tie.second : tie.first, bool(is_inside_[ball]) == tie.is_same_side,
             known * tie.certainty);
      }
    }
  }

 private:
  struct Entry {
    double urgency;
    std::uint32_t ball;
    bool operator<(const Entry& other) const {
      return urgency != other.urgency ? urgency < other.urgency : ball > other.ball;
    }
  };

  std::span<const PolarTie> ties_;
  std::vector<std::vector<std::uint32_t>> of_ball_;
  std::vector<Belief> beliefs_;
  std::vector<char> is_inside_;
  std::priority_queue<Entry> queue_;
};

}  // namespace

double same_side_certainty(const Ball& a, const Ball& b) {
  const double apart2 = (a.centre - b.centre).squaredNorm();
  const double cosine =
      (a.radius * a.radius + b.radius * b.radius - apart2) / (2 * a.radius * b.radius);
  return std::clamp(cosine, 0.0, 1.0);
}

std::vector<char> label_inside(std::size_t balls, std::span<const PolarTie> ties,
                               std::span<const char> is_outer) {
  Labelling labels(balls, ties);
  for (std::uint32_t b = 0; b < balls; ++b)
    if (is_outer[b]) labels.tell(b, false, 1);
  labels.settle();
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (const PolarTie& tie : ties) {
      if (tie.certainty > 0 || labels.is_settled(tie.first) == labels.is_settled(tie.second))
        continue;
      const auto [known, open] = labels.is_settled(tie.first) ? std::pair(tie.first, tie.second)
                                                              : std::pair(tie.second, tie.first);
      labels.tell(open, !labels.is_inside(known), 1);
      labels.settle();
      goes_on = true;
    }
  }
  return labels.all();
}

}  // namespace scan
