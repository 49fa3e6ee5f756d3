// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/global.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

#include "libscan/align/consensus.h"
#include "libscan/align/descriptor_matches.h"
#include "libscan/align/exploration.h"
#include "libscan/align/icp.h"
#include "libscan/align/pose_judge.h"
#include "libscan/core/error.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t least_points = 30;
constexpr std::size_t most_matches = 2000;
constexpr std::size_t most_explored = 64;
// In sides of a cube. Thinned points of two scans lie up to a cube apart on the same surface.
constexpr double noise_in_sides = 1.5, least_distance_in_sides = 5, same_pose_in_sides = 3;
constexpr double slide_in_sides = 5;
constexpr double normal_cosine = 0.3;
// A pose of this share of the best one's merit explains the data as well.
constexpr double equal_merit = 0.85;

std::vector<Pose> proposed(const ScanFeatures& source, const ScanFeatures& target) {
  std::vector<Correspondence> correspondences;
  for (const DescriptorMatch& match : match_descriptors(source, target, most_matches))
    correspondences.push_back({source.cloud.points[match.source], target.cloud.points[match.target],
                               source.cloud.normals[match.source],
                               target.cloud.normals[match.target]});
  const Consensus consensus = find_consensus(
      correspondences, {.noise_m = noise_in_sides * source.side_m,
                        .least_distance_m = least_distance_in_sides * source.side_m,
                        .cosine = normal_cosine,
                        // The surfaces judge more sharply than counts of correspondences do.
                        .most_by_chance = std::numeric_limits<double>::infinity()});
  std::vector<Pose> poses;
  for (const ConsensusPose& pose : consensus.poses) poses.push_back(pose.target_from_source);
  return poses;
}

std::vector<GlobalHypothesis> judged(const PoseJudge& judge, const std::vector<Pose>& proposals) {
  std::vector<GlobalHypothesis> all(proposals.size());
  parallel_for(
      proposals.size(),
      [&](std::size_t i) {
        const Pose pose = judge.settled(proposals[i]);
        const PoseVerdict verdict = judge.judge(pose);
        all[i] = {pose, verdict.trust, verdict.overlap, verdict.conflict, verdict.rms_m};
      },
      1);
  return all;
}

// Root mean square distance between where two poses put the cloud's points.
double apart_m(const PointCloud& cloud, const Pose& a, const Pose& b) {
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / 64);
  double sum2 = 0, count = 0;
  for (std::size_t i = 0; i < cloud.size(); i += stride, ++count)
    sum2 += (a * cloud.points[i] - b * cloud.points[i]).squaredNorm();
  return std::sqrt(sum2 / count);
}

double merit(const GlobalHypothesis& hypothesis) {
  return hypothesis.overlap * hypothesis.trust;
}

// The best of each group of poses that are the same.
std::vector<GlobalHypothesis> different(std::vector<GlobalHypothesis> all,
                                        const ScanFeatures& source) {
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return merit(a) > merit(b); });
  std::vector<GlobalHypothesis> kept;
  for (GlobalHypothesis& hypothesis : all) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const auto& other) {
      return apart_m(source.cloud, hypothesis.target_from_source, other.target_from_source) <
             same_pose_in_sides * source.side_m;
    });
    if (!known) kept.push_back(std::move(hypothesis));
  }
  return kept;
}

// The step of icp from a settled pose, unless it leads elsewhere; the only place that depends on
// it.
void refine(GlobalHypothesis& hypothesis, const ScanFeatures& source, const ScanFeatures& target) {
  const IcpResult refined = icp(source.cloud, target.cloud, hypothesis.target_from_source,
                                {.max_pair_distance_m = source.side_m});
  if (apart_m(source.cloud, refined.target_from_source, hypothesis.target_from_source) <
      same_pose_in_sides * source.side_m)
    hypothesis.target_from_source = refined.target_from_source;
}

bool believed(const GlobalHypothesis& hypothesis, const GlobalOptions& options) {
  return hypothesis.trust >= options.least_trust;
}

// A slide that leaves the points within what the judge tolerates, or another pose that meets as
// much.
GlobalOutcome outcome_of(const std::vector<GlobalHypothesis>& best_first, const PoseJudge& judge,
                         double slide_m, const GlobalOptions& options) {
  if (best_first.empty() || !believed(best_first[0], options)) return GlobalOutcome::no_overlap;
  const double resisted_m = slide_m * judge.least_resistance(best_first[0].target_from_source);
  const bool free = resisted_m < judge.tolerance_m();
  const bool rival = best_first.size() > 1 && believed(best_first[1], options) &&
                     merit(best_first[1]) >= equal_merit * merit(best_first[0]);
  return free || rival ? GlobalOutcome::ambiguous : GlobalOutcome::aligned;
}

}  // namespace

std::string_view name_of(GlobalOutcome outcome) {
  constexpr std::array<std::string_view, 4> names = {"aligned", "ambiguous", "no overlap",
                                                     "too few points"};
  return names[static_cast<std::size_t>(outcome)];
}

void check(const GlobalOptions& options) {
  if (!(options.least_trust >= 0 && options.least_trust <= 1))
    throw Error(Trouble::usage, "global/least_trust: " + std::to_string(options.least_trust) +
                                    ", must be from 0 to 1");
  if (options.most_hypotheses == 0)
    throw Error(Trouble::usage, "global/most_hypotheses: 0, must be 1 or more");
}

GlobalResult align_globally(const ScanFeatures& source, const ScanFeatures& target,
                            const GlobalOptions& options) {
  check(options);
  const Stopwatch watch;
  GlobalResult result;
  if (source.cloud.size() < least_points || target.cloud.size() < least_points) return result;
  if (source.side_m != target.side_m)
    throw Error(Trouble::usage, "global: features of sides " + std::to_string(source.side_m) +
                                    " m and " + std::to_string(target.side_m) +
                                    " m, must be equal");
  const PoseJudge judge(source, target);
  const double slide_m = slide_in_sides * source.side_m;
  std::vector<GlobalHypothesis>& found = result.hypotheses;
  const auto add = [&](const std::vector<Pose>& proposals) {
    auto more = judged(judge, proposals);
    std::move(more.begin(), more.end(), std::back_inserter(found));
    found = different(std::move(found), source);
    return !found.empty() && believed(found[0], options);
  };
  if (add(proposed(source, target)) || add(explore_rotations(source, target, most_explored)))
    add(judge.slid(found[0].target_from_source, slide_m));
  if (found.size() > options.most_hypotheses) found.resize(options.most_hypotheses);
  result.outcome = outcome_of(found, judge, slide_m, options);
  for (GlobalHypothesis& hypothesis : found)
    if (believed(hypothesis, options)) refine(hypothesis, source, target);
  result.cost.seconds = watch.seconds();
  return result;
}

GlobalResult align_globally(const PointCloud& source, const PointCloud& target,
                            const GlobalOptions& options) {
  const Stopwatch watch;
  const std::array<PointCloud, 2> both = {source, target};
  const double side_m = feature_side_m(both);
  if (!(side_m > 0)) return {};
  GlobalResult result = align_globally(describe(source, side_m), describe(target, side_m), options);
  result.cost.seconds = watch.seconds();
  return result;
}

}  // namespace scan
