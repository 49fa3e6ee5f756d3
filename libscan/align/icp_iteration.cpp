// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/icp_iteration.h"

#include <algorithm>
#include <cmath>

#include "libscan/align/extrapolation.h"
#include "libscan/core/median.h"

namespace scan {
namespace {

// The loss's scale in median residuals: wide at first, so that a start far off still pulls, then
// narrowing, so that what has no counterpart pulls no longer. 1.5 medians are one sigma of normal
// noise.
constexpr double widest_scale = 3, narrowest_scale = 1.5, narrowing = 0.8;
// While the scale narrows, one in four points of the source is asked where these are enough, and of
// more than sixteen thousand about four thousand: their noise hides less than the way there is to
// go, whatever the source's size.
constexpr std::size_t least_sample = 1000, most_sample = 4 * least_sample;
constexpr std::size_t coarse_stride = 4;
// A step below three tenths of its standard error adds less than a tenth to the error's square.
constexpr double negligible_share_of_sigma = 0.3;
// A sample's zero is off by its own standard error, the root of six coordinates' variance: nearer
// is of no use.
constexpr double standard_error = 2.45;
// Steps in all, and since the least one.
constexpr int most_settling = 20, most_idle = 3;
// A scale that falls by less is at rest: a tenth wider weighs the noise as well. Where the pose
// creeps, the scale does so too.
constexpr double least_narrowing = 0.9, least_creeping = 0.99;
// Squares weighted by w = rho' / r bend as if rho'' were w: where the loss is that of normal noise,
// twice as much as it does.
constexpr double least_bend = 0.25;

// About one in `stride` points by their places in the cloud as it was given, so that the choice
// does not depend on the frame. Multiples of the golden section (Weyl 1916, Knuth, TAOCP 3, 6.4):
// no row length of a scanner falls in step with them, as with whole strides.
std::vector<std::uint32_t> every(std::size_t stride, const PreparedCloud& source) {
  constexpr std::uint32_t golden = 0x9e3779b9u;
  const auto below = static_cast<std::uint32_t>(0xffffffffu / stride);
  std::vector<std::uint32_t> sample;
  sample.reserve(source.size() / stride + 64);
  for (std::uint32_t i = 0; i < source.size(); ++i)
    if (golden * source.index[i] <= below) sample.push_back(i);
  return sample;
}

// The step to where the loss itself is least, to first order, from that to where its weighted
// squares are.
Step lengthened(Step step) {
  const double factor = 1 / std::max(least_bend, step.bend);
  step.twist *= factor;
  step.change_m *= factor;
  return step;
}

}  // namespace

void IcpIteration::sample_every(std::size_t stride) {
  stride_ = stride;
  sample_ = every(stride, source_);
  matches_.clear();
  finder_.find(pose_, sample_, matches_);
}

double IcpIteration::fitting_scale_m() const {
  const double least_m = 1e-15 * target_.radius_m + 1e-150;
  return std::max(scale_in_medians_ * finder_.median_residual_m(matches_), least_m);
}

// The scale that fits the residuals, never wider than before.
IcpIteration::State IcpIteration::narrow() {
  const double before_m = weighing_.loss.scale_m;
  weighing_.loss.scale_m = fitting_scale_m();
  if (options_.trim_fraction > 0) {
    std::vector<double> residuals_m;
    for (const Match& match : matches_)
      if (match.residual_m < unlimited_m) residuals_m.push_back(match.residual_m);
    weighing_.limit_m =
        std::min(weighing_.limit_m, quantile(std::move(residuals_m), 1 - options_.trim_fraction));
  }
  State state = widened_for_weak(examine(weighing_));
  settled_ = weighing_.loss.scale_m >= (creeps() ? least_creeping : least_narrowing) * before_m;
  if (!settled_ || weighing_.loss.scale_m == before_m) return state;
  weighing_.loss.scale_m = before_m;
  return examine(weighing_);
}

// The few points that alone fix a motion have the worst residuals until it is found: where the loss
// would leave more motions weak than there are, it waits.
IcpIteration::State IcpIteration::widened_for_weak(State state) {
  if (state.weak.cols() <= withheld_.cols()) return state;
  const Eigen::Index least = examine({.loss = {.scale_m = unlimited_m}}).weak.cols();
  if (state.weak.cols() <= least) return state;
  weighing_.limit_m = unlimited_m;
  while (state.weak.cols() > least) {
    weighing_.loss.scale_m *= 2;
    state = examine(weighing_);
  }
  return state;
}

IcpIteration::State IcpIteration::examine(const Weighing& weighing) const {
  State state;
  state.couples = finder_.kept(sample_, matches_, weighing);
  if (state.couples.size() < least_pairs) return state;
  state.frame = frame_of(finder_, pose_, state.couples);
  state.weak = weak_motions(
      motion_information(finder_, pose_, state.couples, state.frame, NormalErrors::of_fits));
  if (state.weak.cols() < withheld_.cols())
    state.weak = carried(withheld_, withheld_frame_, state.frame);
  return state;
}

bool IcpIteration::small(const Vector6& twist, const DataFrame& frame) const {
  return twist.head<3>().norm() <= options_.stop_rotation_rad &&
         twist.tail<3>().norm() * frame.size_m <=
             options_.stop_translation_fraction * 2 * source_.radius_m;
}

Step IcpIteration::next_step(const State& state) const {
  const Step step =
      best_step(finder_, pose_, state.couples, weighing_.loss, state.frame, state.weak);
  // While the scale still follows the residuals these are of the pose, not of noise.
  if (creeps() || !settled_) return step;
  return lengthened(step);
}

// Moves by the step, or by the first of its quarters that does not raise the objective (partners
// found anew); by nothing when even a negligible part would. Returns what was moved.
Vector6 IcpIteration::accept_lower(const State& state, Step step) {
  const double before_m2 = finder_.objective_m2(matches_, weighing_);
  const double negligible_m = negligible_share_of_sigma * step.sigma_m;
  while (true) {
    const Pose there = moved(pose_, step.twist, state.frame);
    std::vector<Match> matches = matches_;
    finder_.find(there, sample_, matches);
    if (finder_.objective_m2(matches, weighing_) <= before_m2) {
      pose_ = there;
      matches_ = std::move(matches);
      return step.twist;
    }
    if (small(step.twist, state.frame) || step.change_m <= negligible_m) return Vector6::Zero();
    step.twist /= 4;
    step.change_m /= 4;
  }
}

// Partners jump as the pose moves: below the noise the objective is rough, and where it is least is
// chance. Its gradient, a sum over all pairs, is less so: Newton's steps lead to where it vanishes,
// extrapolated, since the choice of partners hides much of what a motion changes. At rest where
// they did, or came as near as the jumps let them; on the way where the best of them is lower at
// least; failed where nothing has moved.
IcpIteration::Settling IcpIteration::settle(const State& state, Step step) {
  const Pose start = pose_;
  const double before_m2 = finder_.objective_m2(matches_, weighing_);
  const double enough = stride_ > 1 ? standard_error : negligible_share_of_sigma;
  State here = state;
  Extrapolation extrapolation;
  Pose best = start;
  double least_m = unlimited_m;
  for (int k = 0, at = 0; k < most_settling && here.couples.size() >= least_pairs; ++k) {
    pose_ = moved(pose_, extrapolation.move(step.twist, step.squares_m2, step.sigma_m), here.frame);
    finder_.find(pose_, sample_, matches_);
    if (small(step.twist, here.frame) || step.change_m <= enough * step.sigma_m)
      return Settling::at_rest;
    here = examine(weighing_);
    step = next_step(here);
    if (step.change_m < least_m)
      best = pose_, least_m = step.change_m, at = k;
    else if (k - at >= most_idle)
      break;
  }
  pose_ = best;
  finder_.find(pose_, sample_, matches_);
  if (least_m <= step.sigma_m) return Settling::at_rest;
  if (finder_.objective_m2(matches_, weighing_) < before_m2) return Settling::on_the_way;
  pose_ = start;
  finder_.find(pose_, sample_, matches_);
  return Settling::failed;
}

void IcpIteration::count_iteration(IcpResult& result) const {
  ++result.iterations;
  if (options_.on_iteration)
    options_.on_iteration(result.iterations, global_pose(pose_, source_, target_));
}

// One step. Returns whether another one may follow.
bool IcpIteration::iterate(IcpResult& result) {
  const State state = narrow();
  if (state.couples.size() < least_pairs) return false;
  const Step step = next_step(state);
  result.history.push_back(
      {weighing_.loss.scale_m, finder_.objective_m2(matches_, weighing_), step.sigma_m});
  const bool last_scale = scale_in_medians_ <= narrowest_scale && settled_;
  bool done = false;
  const Settling settling = last_scale && !creeps() ? settle(state, step) : Settling::failed;
  if (settling == Settling::at_rest)
    done = fitting_scale_m() >= least_narrowing * weighing_.loss.scale_m;
  else if (settling == Settling::failed)
    done = small(accept_lower(state, step), state.frame) && last_scale;
  count_iteration(result);
  if (done && stride_ == 1) return false;
  if (done) sample_every(1);
  scale_in_medians_ = std::max(narrowest_scale, narrowing * scale_in_medians_);
  return true;
}

// From the guess to rest, or to the limit of iterations. Returns whether it was still moving.
bool IcpIteration::descend(const Pose& guess, IcpResult& result) {
  pose_ = local_pose(guess, source_, target_);
  weighing_ = {.loss = {.scale_m = unlimited_m}};
  scale_in_medians_ = widest_scale;
  // Point-to-point is held by the points themselves: fewer would hold it elsewhere.
  const bool coarse = !creeps() && source_.size() / coarse_stride >= least_sample;
  sample_every(coarse ? std::max(coarse_stride, source_.size() / most_sample) : 1);
  near_ = is_near();
  if (opening_ > 0) approach(result);
  bool moving = true;
  while (moving && may_go_on(result)) moving = iterate(result);
  if (stride_ > 1) sample_every(1);
  return moving;
}

// Where the scans lie on each other their normals differ by the noise of both, also by what
// neighbours share and no fit can see. Returns whether that hides more than was withheld.
bool IcpIteration::withhold_more(const State& state) {
  const TwistBasis weak = weak_motions(
      motion_information(finder_, pose_, state.couples, state.frame, NormalErrors::between_scans));
  if (weak.cols() <= state.weak.cols()) return false;
  withheld_ = weak;
  withheld_frame_ = state.frame;
  return true;
}

Stop IcpIteration::judge(const State& state) const {
  if (state.weak.cols() > 0) return Stop::degenerate;
  std::vector<bool> partners(target_.size(), false);
  for (const Couple& couple : state.couples) partners[couple.target] = true;
  const auto seen = static_cast<double>(std::count(partners.begin(), partners.end(), true));
  const double overlap =
      std::max(static_cast<double>(state.couples.size()) / static_cast<double>(sample_.size()),
               seen / static_cast<double>(target_.size()));
  return overlap < options_.min_overlap ? Stop::low_overlap : Stop::converged;
}

void IcpIteration::report(const State& state, IcpResult& result) const {
  result.target_from_source = global_pose(pose_, source_, target_);
  result.pairs = state.couples.size();
  result.inlier_fraction_of_source =
      static_cast<double>(state.couples.size()) / static_cast<double>(sample_.size());
  result.rms_m = rms_m(state.couples, weighing_.loss);
  result.centre = target_.origin + state.frame.centre;
  result.weak_directions = name_motions(state.weak, state.frame, target_.origin);
  result.information =
      pose_information(finder_, pose_, state.couples, weighing_.loss, state.frame, state.weak);
}

void IcpIteration::run(const Pose& guess, IcpResult& result) {
  bool moving = descend(guess, result);
  State state = examine(weighing_);
  if (!moving && seek_better(guess, result)) state = examine(weighing_);
  // What was moved along them meant nothing: once more from the guess without.
  if (state.couples.size() >= least_pairs && !moving && withhold_more(state)) {
    result.history.clear();
    moving = descend(guess, result);
    state = examine(weighing_);
  }
  if (state.couples.size() < least_pairs) {
    result.stop = Stop::no_correspondences;
    return;
  }
  report(state, result);
  result.stop = moving ? Stop::iteration_limit : judge(state);
}

}  // namespace scan
