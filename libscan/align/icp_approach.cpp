// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Other ways to rest, for guesses far off.
//
// The gates (PairFinder::find) let only those points pull that lie over their partners: right where
// the scans share little, but from far off the points that know the way are among the refused. So
// a rest at which the scans do not lie on each other as each lies on itself, or contradict each
// other where both are seen, is sought again with the gates open, as far as a share of the points
// are off, and closing step by step: first a narrow share, for what a small overlap has to say,
// then nearly all.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "libscan/align/icp_iteration.h"
#include "libscan/core/median.h"

namespace scan {
namespace {

constexpr std::array openings = {0.25, 0.9};
// Each step closes the gates by so much, until the local fits reach as far.
constexpr double closing = 0.7, closed_in_spacings = 2;
// Of 800 starts of six shapes, right rests were rougher than the scans by -20 to 20 %, two in three
// of the wrong ones by 50 % and more; of guesses that pair more than this share none went wrong.
constexpr double most_roughness = 1.3, near_share = 0.7;
// Wrong ones as smooth as right ones, slid along what has the largest area, were contradicted by 20
// to 60 % of the points over the target, right ones by at most 2 %, of exact scans, whose residuals
// have the long tails of what curvature leaves, by at most 6 %.
constexpr double most_contradicted = 0.1, least_gain = 0.7;
constexpr double contradicting_scales = 10;
// Planes that change so much between halves of their neighbours, 11 degrees, contradict nothing.
constexpr double most_tilt = 0.2;
constexpr std::size_t most_asked = 512;

std::size_t stride_over(std::size_t count) {
  return std::max<std::size_t>(1, count / most_asked);
}

// Of local surfaces of both scans from the nearest neighbours of their points.
double median_own_distance_m(const PreparedCloud& source, const PreparedCloud& target) {
  std::vector<double> distances_m;
  for (const PreparedCloud* cloud : {&source, &target})
    for (std::size_t i = 0; i < cloud->size(); i += stride_over(cloud->size()))
      if (cloud->fits[i].shape == LocalShape::surface)
        distances_m.push_back(cloud->fits[i].neighbour_off_m);
  return median(std::move(distances_m));
}

bool is_certain(const LocalFit& fit) {
  return fit.shape == LocalShape::surface && fit.tilt.squaredNorm() < most_tilt * most_tilt;
}

}  // namespace

bool IcpIteration::is_near() const {
  const auto paired = std::count_if(matches_.begin(), matches_.end(), [](const Match& match) {
    return match.residual_m < unlimited_m;
  });
  return static_cast<double>(paired) > near_share * static_cast<double>(matches_.size());
}

// How far the pairs lie off each other, as multiples of how far neighbours in one scan do; 0 for
// none, which no gates were too narrow for.
double IcpIteration::roughness() const {
  std::vector<double> distances_m;
  for (std::size_t k = 0; k < matches_.size(); k += stride_over(matches_.size())) {
    const std::uint32_t j = matches_[k].target;
    if (matches_[k].residual_m == unlimited_m || target_.normals[j].isZero(0)) continue;
    const Eigen::Vector3d apart = pose_ * source_.points[sample_[k]] - target_.points[j];
    distances_m.push_back(std::abs(target_.normals[j].dot(apart)));
  }
  const double apart_m = median(std::move(distances_m));
  return apart_m > 0 ? apart_m / median_own_distance_m(source_, target_) : 0;
}

// Share of the points over the target's surface that are far off it, or turned away: what scans do
// not share lies beyond the rims, but what lies wrong is above and below the surface.
double IcpIteration::contradicted() const {
  std::size_t over = 0, off = 0;
  const double most_m = contradicting_scales * weighing_.loss.scale_m;
  for (std::size_t k = 0; k < matches_.size(); k += stride_over(matches_.size())) {
    const std::uint32_t j = matches_[k].target;
    if (j == no_point || !is_certain(target_.fits[j]) || !is_certain(source_.fits[sample_[k]]))
      continue;
    const Eigen::Vector3d apart = pose_ * source_.points[sample_[k]] - target_.points[j];
    const double across_m = target_.normals[j].dot(apart);
    const double reach_m = plane_share_of_reach * target_.fits[j].reach_m;
    if (apart.squaredNorm() - across_m * across_m > reach_m * reach_m) continue;
    ++over;
    off += matches_[k].residual_m > most_m;
  }
  return over > 0 ? static_cast<double>(off) / static_cast<double>(over) : 0;
}

// From gates as wide as the opening's share of the sample is off to closed ones.
void IcpIteration::approach(IcpResult& result) {
  std::vector<double> distances_m;
  for (std::size_t k = 0; k < sample_.size(); ++k)
    if (matches_[k].target != no_point)
      distances_m.push_back(
          (pose_ * source_.points[sample_[k]] - target_.points[matches_[k].target]).norm());
  double open_m = quantile(std::move(distances_m), opening_);
  for (; open_m > closed_in_spacings * target_.spacing_m && may_go_on(result); open_m *= closing) {
    finder_.open_gates(open_m);
    finder_.find(pose_, sample_, matches_);
    const State state = examine(weighing_);
    if (state.couples.size() < least_pairs) break;
    const Step step =
        best_step(finder_, pose_, state.couples, weighing_.loss, state.frame, state.weak);
    pose_ = moved(pose_, step.twist, state.frame);
    count_iteration(result);
  }
  finder_.open_gates(0);
  finder_.find(pose_, sample_, matches_);
}

// Leaves a rest for another that is smoother by as much as a right one may be rough, or that fewer
// points contradict, and has the lower loss, of the scale that fits the closer one. Returns whether
// there was one.
bool IcpIteration::seek_better(const Pose& guess, IcpResult& result) {
  bool found = false;
  double rough = near_ ? 0 : roughness(), against = contradicted();
  for (std::size_t k = 0; k < openings.size() && may_go_on(result) &&
                          (rough > most_roughness || against > most_contradicted);
       ++k) {
    const Rest before{pose_, matches_, weighing_, opening_};
    const std::vector<IcpState> history = std::exchange(result.history, {});
    opening_ = openings[k];
    const bool moving = descend(guess, result);
    const Weighing common{
        .loss = {.scale_m = std::min(weighing_.loss.scale_m, before.weighing.loss.scale_m)}};
    const double rough_here = roughness(), against_here = contradicted();
    const bool better = rough_here * most_roughness < rough || against_here < least_gain * against;
    if (!moving && better &&
        finder_.objective_m2(matches_, common) < finder_.objective_m2(before.matches, common)) {
      found = true;
      rough = rough_here, against = against_here;
      continue;
    }
    pose_ = before.pose, matches_ = before.matches;
    weighing_ = before.weighing, opening_ = before.opening;
    result.history = history;
  }
  return found;
}

}  // namespace scan
