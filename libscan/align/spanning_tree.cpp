// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/spanning_tree.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

namespace scan {
namespace {

// A motion that an edge fixes this much worse than its best one counts as open.
constexpr double open_share = 1e-9;
constexpr double limit_of_six = 22.458;  // 99.9 % quantile of chi-square

// Carries a twist through a pose: pose exp(x) pose^-1 = exp(adjoint x) for left twists.
Matrix6 adjoint(const Pose& pose) {
  Matrix6 a = Matrix6::Zero();
  a.topLeftCorner<3, 3>() = a.bottomRightCorner<3, 3>() = pose.linear();
  a.bottomLeftCorner<3, 3>() = cross_matrix(pose.translation()) * pose.linear();
  return a;
}

// An edge as it is walked from `from` to `to`, with the covariance of a left twist in `to`'s frame.
struct Step {
  std::size_t edge = 0;
  Pose to_from_from = Pose::Identity();
  Matrix6 covariance = Matrix6::Zero();
};

Matrix6 covariance_of(const Matrix6& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(information);
  const double least =
      std::max(open_share * solver.eigenvalues()[5], std::numeric_limits<double>::min());
  const Vector6 variances = solver.eigenvalues().cwiseMax(least).cwiseInverse();
  return solver.eigenvectors() * variances.asDiagonal() * solver.eigenvectors().transpose();
}

using Steps = std::vector<std::multimap<std::size_t, Step>>;  // per scan: where one can go

Steps steps_of(std::span<const PoseEdge> edges, std::size_t scans) {
  Steps steps(scans);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const PoseEdge& edge = edges[i];
    const Pose back = edge.target_from_source.inverse();
    const Matrix6 covariance = covariance_of(edge.information);
    const Matrix6 carried = adjoint(back) * covariance * adjoint(back).transpose();
    steps[edge.source].emplace(edge.target, Step{i, edge.target_from_source, covariance});
    steps[edge.target].emplace(edge.source, Step{i, back, carried});
  }
  return steps;
}

// From a scan over `first`, `second` and `third` back to it.
bool closes(const Step& first, const Step& second, const Step& third) {
  const Pose loop = third.to_from_from * second.to_from_from * first.to_from_from;
  const Matrix6 a2 = adjoint(third.to_from_from);
  const Matrix6 a1 = adjoint(third.to_from_from * second.to_from_from);
  const Matrix6 covariance = third.covariance + a2 * second.covariance * a2.transpose() +
                             a1 * first.covariance * a1.transpose();
  const Vector6 error = log(loop);
  return error.dot(covariance.ldlt().solve(error)) <= limit_of_six;
}

// Scans that are joined already move as one.
struct Forest {
  std::vector<std::size_t> cluster;            // per scan
  std::vector<Pose> cluster_from_scan;         // per scan
  std::vector<std::vector<std::size_t>> tree;  // per scan: its neighbours

  explicit Forest(std::size_t scans)
      : cluster(scans), cluster_from_scan(scans, Pose::Identity()), tree(scans) {
    std::iota(cluster.begin(), cluster.end(), std::size_t{0});
  }
  bool joins(const PoseEdge& edge) const { return cluster[edge.source] != cluster[edge.target]; }
  // Of the source's cluster in the target's, if the edge is right.
  Pose target_from_source(const PoseEdge& edge) const {
    return cluster_from_scan[edge.target] * edge.target_from_source *
           cluster_from_scan[edge.source].inverse();
  }
  // Rounding makes of each factor less of a rotation; of products of products it would double with
  // each join.
  void join(const PoseEdge& edge) {
    const Pose product = target_from_source(edge);
    const Pose target_from_source_cluster =
        make_pose(nearest_rotation(product.linear()), product.translation());
    const std::size_t kept = cluster[edge.target], gone = cluster[edge.source];
    for (std::size_t i = 0; i < cluster.size(); ++i) {
      if (cluster[i] != gone) continue;
      cluster[i] = kept;
      cluster_from_scan[i] = target_from_source_cluster * cluster_from_scan[i];
    }
    tree[edge.source].push_back(edge.target);
    tree[edge.target].push_back(edge.source);
  }
};

// Squared error of `edge` if the motion between the clusters is what `other` says.
double chi_square(const PoseEdge& edge, const PoseEdge& other, const Forest& forest) {
  const bool same_way = forest.cluster[edge.target] == forest.cluster[other.target];
  const Pose hypothesis =
      same_way ? forest.target_from_source(other) : forest.target_from_source(other).inverse();
  const Vector6 error =
      log(forest.cluster_from_scan[edge.target].inverse() * hypothesis *
          forest.cluster_from_scan[edge.source] * edge.target_from_source.inverse());
  return error.dot(edge.information * error);
}

// The edge between two clusters with which most others between the same two agree, as far as the
// errors of a walk through all scans, all off the same way, allow; of equals the one that fewest
// contradict, then the first. None if no edge joins two clusters.
std::optional<std::size_t> best_join(std::span<const PoseEdge> edges, const Forest& forest) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> between;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (forest.joins(edges[i]))
      between[std::minmax(forest.cluster[edges[i].source], forest.cluster[edges[i].target])]
          .push_back(i);
  const auto walk = static_cast<double>(forest.cluster.size());
  using Rank = std::tuple<std::ptrdiff_t, std::ptrdiff_t, std::size_t>;  // the lowest is the best
  std::optional<Rank> best;
  for (const auto& [clusters, list] : between)
    for (const std::size_t i : list) {
      const std::ptrdiff_t votes = std::ranges::count_if(list, [&](std::size_t k) {
        return chi_square(edges[k], edges[i], forest) <= walk * walk * limit_of_six;
      });
      const Rank rank{-votes, std::ssize(list) - votes, i};
      if (!best || rank < *best) best = rank;
    }
  return best ? std::optional(std::get<std::size_t>(*best)) : std::nullopt;
}

// Numbers of edges from the anchor; none where the tree does not lead.
std::vector<std::optional<std::size_t>> depths(const Forest& forest, std::size_t anchor) {
  std::vector<std::optional<std::size_t>> depth(forest.tree.size());
  depth[anchor] = 0;
  std::vector<std::size_t> walk{anchor};
  for (std::size_t k = 0; k < walk.size(); ++k)
    for (const std::size_t next : forest.tree[walk[k]]) {
      if (depth[next]) continue;
      depth[next] = *depth[walk[k]] + 1;
      walk.push_back(next);
    }
  return depth;
}

}  // namespace

std::vector<int> closed_loops(std::span<const PoseEdge> edges, std::size_t scans) {
  const Steps steps = steps_of(edges, scans);
  std::vector<int> count(edges.size(), 0);
  for (std::size_t a = 0; a < scans; ++a)
    for (const auto& [b, first] : steps[a]) {
      if (b <= a) continue;  // each loop once: a is its lowest scan, b the next
      for (const auto& [c, second] : steps[b]) {
        if (c <= b) continue;
        const auto [begin, end] = steps[c].equal_range(a);
        for (auto third = begin; third != end; ++third)
          if (closes(first, second, third->second))
            for (const std::size_t edge : {first.edge, second.edge, third->second.edge})
              ++count[edge];
      }
    }
  return count;
}

SpanningTree spanning_tree(std::span<const Pose> starts, std::span<const PoseEdge> edges,
                           std::size_t anchor) {
  const std::vector<int> loops = closed_loops(edges, starts.size());
  std::vector<std::size_t> order(edges.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return loops[a] > loops[b]; });
  Forest forest(starts.size());
  for (const std::size_t i : order)
    if (loops[i] > 0 && forest.joins(edges[i])) forest.join(edges[i]);
  while (const auto i = best_join(edges, forest)) forest.join(edges[*i]);
  SpanningTree result{.world_from_scan = {starts.begin(), starts.end()},
                      .reached = std::vector<bool>(starts.size(), false)};
  const Pose world_from_cluster = starts[anchor] * forest.cluster_from_scan[anchor].inverse();
  const auto depth = depths(forest, anchor);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (!depth[i]) continue;
    result.reached[i] = true;
    result.depth = std::max(result.depth, *depth[i]);
    if (i != anchor) result.world_from_scan[i] = world_from_cluster * forest.cluster_from_scan[i];
  }
  return result;
}

}  // namespace scan
