// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/global_guesses.h"

#include <algorithm>

namespace scan {
namespace {

// Where nearly all normals face it the viewpoint is the scanner's place, and not just the origin of
// a cloud that was put together.
constexpr double facing_share = 0.95;

std::optional<Eigen::Vector3d> viewpoint_of(const Scan& scan) {
  double facing = 0, used = 0;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const Eigen::Vector3d& normal = scan.cloud.normals[i];
    if (normal.isZero(0)) continue;
    ++used;
    facing += normal.dot(scan.viewpoint - scan.cloud.points[i]) > 0;
  }
  if (facing < facing_share * used) return std::nullopt;
  return scan.viewpoint;
}

std::vector<ScanFeatures> describe_all(std::span<const Scan> scans) {
  std::vector<PointCloud> clouds;
  for (const Scan& scan : scans) clouds.push_back(scan.cloud);
  const double side_m = feature_side_m(clouds);
  std::vector<ScanFeatures> features(scans.size());
  if (!(side_m > 0)) return features;
  for (std::size_t i = 0; i < scans.size(); ++i)
    features[i] = describe(scans[i].cloud, side_m, viewpoint_of(scans[i]));
  return features;
}

struct Tie {
  std::size_t source = 0, target = 0;
  GlobalOutcome outcome = GlobalOutcome::no_overlap;
  GlobalHypothesis best;
};

std::vector<Tie> all_ties(const std::vector<ScanFeatures>& features, const Progress& progress) {
  std::vector<Tie> ties;
  const std::size_t pairs = features.size() * (features.size() - 1) / 2;
  for (std::size_t target = 0; target < features.size(); ++target)
    for (std::size_t source = target + 1; source < features.size(); ++source) {
      const GlobalResult found = align_globally(features[source], features[target]);
      ties.push_back({source, target, found.outcome,
                      found.hypotheses.empty() ? GlobalHypothesis{} : found.hypotheses.front()});
      if (progress) progress("find overlaps", double(ties.size()) / double(pairs));
    }
  return ties;
}

bool holds(const Tie& tie) {
  return tie.outcome == GlobalOutcome::aligned || tie.outcome == GlobalOutcome::ambiguous;
}

// Aligned ones before ambiguous ones, each by how much meets and how surely.
bool surer(const Tie& a, const Tie& b) {
  if (a.outcome != b.outcome) return a.outcome == GlobalOutcome::aligned;
  return a.best.trust * a.best.overlap > b.best.trust * b.best.overlap;
}

}  // namespace

std::vector<GlobalGuess> global_guesses(std::span<const Scan> scans, const Progress& progress) {
  std::vector<GlobalGuess> guesses(scans.size());
  if (scans.empty()) return guesses;
  std::vector<Tie> ties = all_ties(describe_all(scans), progress);
  std::erase_if(ties, [](const Tie& tie) { return !holds(tie); });
  std::stable_sort(ties.begin(), ties.end(), surer);
  std::vector<bool> placed(scans.size(), false);
  placed[0] = true;
  guesses[0] = {Pose::Identity(), GlobalOutcome::aligned, 1};
  while (true) {
    const auto next = std::find_if(ties.begin(), ties.end(), [&](const Tie& tie) {
      return placed[tie.source] != placed[tie.target];
    });
    if (next == ties.end()) return guesses;
    const bool forth = placed[next->target];
    const std::size_t known = forth ? next->target : next->source;
    const std::size_t added = forth ? next->source : next->target;
    const Pose& target_from_source = next->best.target_from_source;
    const Pose known_from_added = forth ? target_from_source : target_from_source.inverse();
    guesses[added] = {guesses[known].world_from_scan * known_from_added, next->outcome,
                      next->best.trust};
    placed[added] = true;
  }
}

}  // namespace scan
