// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/consensus.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libscan/align/clique.h"
#include "libscan/align/rigid_fit.h"
#include "libscan/core/parallel.h"
#include "libscan/core/random.h"

namespace scan {
namespace {

constexpr std::uint64_t clique_budget = 1'000'000;  // word operations: a millisecond
constexpr std::size_t least_members = 3;
constexpr std::size_t most_seeds = 512;
constexpr int refits = 3;

std::vector<std::uint32_t> inliers_of(std::span<const Correspondence> all, const Pose& pose,
                                      double noise_m) {
  std::vector<std::uint32_t> inliers;
  for (std::uint32_t i = 0; i < all.size(); ++i)
    if ((pose * all[i].source - all[i].target).squaredNorm() <= noise_m * noise_m)
      inliers.push_back(i);
  return inliers;
}

Pose fitted(std::span<const Correspondence> all, const std::vector<std::uint32_t>& members) {
  std::vector<Eigen::Vector3d> source, target;
  for (const std::uint32_t i : members) {
    source.push_back(all[i].source);
    target.push_back(all[i].target);
  }
  return rigid_fit(source, target).target_from_source;
}

ConsensusPose pose_of(std::span<const Correspondence> all, std::vector<std::uint32_t> members,
                      double noise_m) {
  ConsensusPose best;
  for (int round = 0; round < refits && members.size() >= least_members; ++round) {
    const Pose pose = fitted(all, members);
    members = inliers_of(all, pose, noise_m);
    if (members.size() <= best.inliers.size()) break;
    best = {pose, members, 0};
  }
  return best;
}

// Correspondences by falling number of those they agree with.
std::vector<std::uint32_t> by_degree(const BitGraph& graph) {
  std::vector<std::size_t> degree(graph.size());
  parallel_for(graph.size(), [&](std::size_t i) { degree[i] = graph.degree(i); });
  std::vector<std::uint32_t> order(graph.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return degree[a] > degree[b]; });
  return order;
}

struct Candidates {
  std::vector<ConsensusPose> poses;
  std::vector<std::uint32_t> largest;  // clique
};

// A clique and its pose around each correspondence that no pose before explains.
Candidates explore(std::span<const Correspondence> all, const BitGraph& graph, double noise_m) {
  Candidates found;
  std::vector<bool> explained(all.size(), false);
  std::size_t seeds = 0;
  for (const std::uint32_t seed : by_degree(graph)) {
    if (explained[seed]) continue;
    if (++seeds > most_seeds) break;
    std::vector<std::uint32_t> clique = greedy_clique(graph, seed);
    for (const std::uint32_t i : clique) explained[i] = true;
    if (clique.size() < least_members) continue;
    found.poses.push_back(pose_of(all, clique, noise_m));
    const Pose& pose = found.poses.back().target_from_source;
    for (const std::uint32_t i : inliers_of(all, pose, 2 * noise_m)) explained[i] = true;
    if (clique.size() > found.largest.size()) found.largest = std::move(clique);
  }
  return found;
}

// How often unrelated correspondences agree by chance.
struct Chance {
  double distance = 0;  // the distance of two, with that between the targets of two others
  double place = 0;     // the target of one, with the place that a motion gives to it
};

// From draws; at least one is taken to agree, since none need be seen. A motion that three
// correspondences fix to the noise gives a place to twice that.
Chance chance_of(std::span<const Correspondence> all, double noise_m) {
  constexpr std::size_t draws = 8192;
  RandomStream random(0, 0, 0);
  const auto draw = [&] { return std::size_t(random.uniform() * static_cast<double>(all.size())); };
  double distances = 1, places = 1;
  for (std::size_t k = 0; k < draws; ++k) {
    const std::size_t a = draw(), b = draw(), c = draw(), d = draw();
    if (a == b || c == d) continue;
    const double source_m = (all[a].source - all[b].source).norm();
    const double target_m = (all[c].target - all[d].target).norm();
    distances += std::abs(source_m - target_m) <= 2 * noise_m;
    places += target_m <= 2 * noise_m;
  }
  return {distances / (draws + 1), places / (draws + 1)};
}

// Expected number of sets of k out of n unrelated correspondences that one motion explains: three
// fix it and must agree in three distances, the others must land in their places (the a-contrario
// principle of Desolneux, Moisan and Morel 2000).
double expected_by_chance(std::size_t n, std::size_t k, const Chance& chance) {
  const auto total = static_cast<double>(n), chosen = static_cast<double>(k);
  const double log_sets =
      std::lgamma(total + 1) - std::lgamma(chosen + 1) - std::lgamma(total - chosen + 1);
  const double log_agree = 3 * std::log(chance.distance) + (chosen - 3) * std::log(chance.place);
  return std::exp(std::min(log_sets + log_agree, 700.0));
}

double shared_share(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  std::vector<std::uint32_t> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return static_cast<double>(both.size()) / static_cast<double>(std::min(a.size(), b.size()));
}

}  // namespace

Consensus find_consensus(std::span<const Correspondence> correspondences,
                         const ConsensusOptions& options) {
  const BitGraph graph = compatibility(
      correspondences, {2 * options.noise_m, options.least_distance_m, options.cosine});
  Consensus result;
  auto [poses, known] = explore(correspondences, graph, options.noise_m);
  if (poses.empty()) return result;
  const std::size_t found = known.size();
  const Clique largest = largest_clique(graph, std::move(known), clique_budget);
  result.clique_bound = largest.upper_bound;
  result.largest_clique = largest.members.size();
  if (result.largest_clique > found)
    poses.push_back(pose_of(correspondences, largest.members, options.noise_m));
  std::stable_sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) {
    return a.inliers.size() > b.inliers.size();
  });
  const Chance chance = chance_of(correspondences, options.noise_m);
  for (ConsensusPose& pose : poses) {
    if (pose.inliers.size() < least_members || result.poses.size() == options.most_poses) break;
    const bool seen = std::any_of(result.poses.begin(), result.poses.end(), [&](const auto& other) {
      return shared_share(pose.inliers, other.inliers) > 0.5;
    });
    if (seen) continue;
    pose.expected_by_chance = expected_by_chance(graph.size(), pose.inliers.size(), chance);
    if (pose.expected_by_chance > options.most_by_chance) break;
    result.poses.push_back(std::move(pose));
  }
  return result;
}

}  // namespace scan
