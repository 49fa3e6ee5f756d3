// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/orientation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <unordered_map>
#include <utility>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr double content = 0.005;  // share of bonds that may disagree
constexpr double orderly = 0.1;    // share up to which the given sides are no accident
constexpr double no_majority = 0.6;
constexpr double least_clarity =
    0.5;  // sum of the bonds between two groups over that of their sizes

struct Bond {
  std::uint32_t a, b;  // a < b
  double strength;     // positive: the same side
};

// 1 for parallel normals in one plane; 0 where they are 45 degrees apart or where the step from one
// to the other leaves either's plane by 30 degrees, as from one side of a thin plate to the other.
double strength(const Eigen::Vector3d& offset, const Eigen::Vector3d& n, const Eigen::Vector3d& m) {
  const double cosine = n.dot(m), distance2 = offset.squaredNorm();
  if (!(distance2 > 0)) return cosine;
  const double across = std::max(std::abs(n.dot(offset)), std::abs(m.dot(offset)));
  const double tilt2 = across * across / distance2;
  const double weight = (2 * cosine * cosine - 1) * (1 - 4 * tilt2);
  return tilt2 < 0.25 && cosine * cosine > 0.5 ? std::copysign(weight, cosine) : 0;
}

std::vector<Bond> bonds_between(std::span<const Eigen::Vector3d> points,
                                std::span<const std::uint32_t> around,
                                std::span<const Eigen::Vector3d> normals) {
  const std::size_t k = around.size() / points.size();
  std::vector<std::vector<Bond>> parts((points.size() + 1023) / 1024);
  parallel_chunks(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i)
      for (std::size_t n = 0; n < k; ++n) {
        const std::uint32_t j = around[i * k + n];
        const auto back = around.subspan(j * k, k);
        const bool mutual = std::find(back.begin(), back.end(), i) != back.end();
        if (mutual && j < i) continue;  // listed by the other one
        const double s = strength(points[j] - points[i], normals[i], normals[j]);
        if (s != 0) parts[begin / 1024].push_back({std::min(i, j), std::max(i, j), s});
      }
  });
  std::vector<Bond> bonds;
  for (const auto& part : parts) bonds.insert(bonds.end(), part.begin(), part.end());
  return bonds;
}

// Share of the bonds that are at odds, by strength.
double disagreement(const std::vector<Bond>& bonds) {
  double all = 0, wrong = 0;
  for (const Bond& bond : bonds) {
    all += std::abs(bond.strength);
    wrong -= std::min(0.0, bond.strength);
  }
  return all > 0 ? wrong / all : 0;
}

// Groups of points whose sides are decided relative to one another.
class Groups {
 public:
  Groups(std::size_t points, const std::vector<Bond>& bonds)
      : parent_(points), side_(points, 1), bonds_(points) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    for (const Bond& bond : bonds) {
      const Total total{bond.strength, std::abs(bond.strength)};
      bonds_[bond.a][bond.b] += total;
      bonds_[bond.b][bond.a] += total;
      push(bond.a, bond.b, total);
    }
  }

  void contract() {
    while (!queue_.empty()) {
      const Entry top = queue_.top();
      queue_.pop();
      if (parent_[top.a] != top.a || parent_[top.b] != top.b) continue;
      const auto bond = bonds_[top.a].find(top.b);
      if (bond == bonds_[top.a].end() || std::abs(bond->second.sum) != top.weight) continue;
      join(top.a, top.b, bond->second.sum < 0 ? -1 : 1);
    }
  }

  // The group of a point and its side there.
  std::pair<std::uint32_t, int> group(std::uint32_t i) const {
    int side = 1;
    for (; parent_[i] != i; i = parent_[i]) side *= side_[i];
    return {i, side};
  }

 private:
  // Of the bonds between two groups: with their signs, and without.
  struct Total {
    double sum = 0, sizes = 0;
    void operator+=(const Total& other) {
      sum += other.sum;
      sizes += other.sizes;
    }
  };
  struct Entry {
    double weight;
    std::uint32_t a, b;
    // Ties are decided by number: one order for all runs.
    bool operator<(const Entry& other) const {
      if (weight != other.weight) return weight < other.weight;
      return std::pair(a, b) > std::pair(other.a, other.b);
    }
  };

  // Bonds that contradict one another join nothing.
  void push(std::uint32_t a, std::uint32_t b, const Total& total) {
    const double weight = std::abs(total.sum);
    if (weight > 0 && weight >= least_clarity * total.sizes)
      queue_.push({weight, std::min(a, b), std::max(a, b)});
  }

  // Bonds of the one with fewer go over to the other.
  void join(std::uint32_t a, std::uint32_t b, int side) {
    if (bonds_[a].size() < bonds_[b].size()) std::swap(a, b);
    parent_[b] = a;
    side_[b] = static_cast<signed char>(side);
    bonds_[a].erase(b);
    const std::unordered_map<std::uint32_t, Total> moved = std::exchange(bonds_[b], {});
    for (const auto& [other, total] : moved) {
      if (other == a) continue;
      bonds_[other].erase(b);
      Total& sum = bonds_[a][other];
      sum += {side * total.sum, total.sizes};
      bonds_[other][a] = sum;
      push(a, other, sum);
    }
  }

  std::vector<std::uint32_t> parent_;
  std::vector<signed char> side_;
  std::vector<std::unordered_map<std::uint32_t, Total>> bonds_;
  std::priority_queue<Entry> queue_;
};

struct Vote {
  double as_given = 0, turned = 0;
  double outward = 0;
};

}  // namespace

std::size_t agree_with_neighbours(std::span<const Eigen::Vector3d> points,
                                  std::span<const std::uint32_t> around,
                                  std::span<Eigen::Vector3d> normals) {
  if (points.empty()) return 0;
  const std::vector<Bond> bonds = bonds_between(points, around, normals);
  const double at_odds = disagreement(bonds);
  if (at_odds <= content) return 0;
  Groups groups(points.size(), bonds);
  groups.contract();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto& x : points) centre += x / static_cast<double>(points.size());
  std::vector<Vote> votes(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto [group, side] = groups.group(i);
    (side > 0 ? votes[group].as_given : votes[group].turned) += 1;
    votes[group].outward += side * normals[i].dot(points[i] - centre);
  }
  std::size_t turned = 0;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto [group, side] = groups.group(i);
    const Vote& vote = votes[group];
    const double most = std::max(vote.as_given, vote.turned);
    const bool has_majority = most >= no_majority * (vote.as_given + vote.turned);
    if (!has_majority && at_odds < orderly) continue;
    const bool keep = has_majority ? vote.as_given >= vote.turned : vote.outward >= 0;
    if ((side > 0) != keep) {
      normals[i] = -normals[i];
      ++turned;
    }
  }
  return turned;
}

}  // namespace scan
