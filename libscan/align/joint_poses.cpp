// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_poses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "libscan/align/joint_guesses.h"
#include "libscan/align/joint_motion.h"
#include "libscan/align/overlaps.h"
#include "libscan/align/rims.h"
#include "libscan/core/median.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

// Each point is asked in so many other scans, whatever their number.
constexpr std::size_t most_partners = 16;
// At poses near the answer, points this many spacings apart, or what noise puts between them, may
// be partners.
constexpr double reach_in_spacings = 3;
// Steps below half a standard error change nothing that can be known.
constexpr double negligible_square = 0.25;
// The loss narrows anew from where the scans came to stand together: what a first narrowing left
// out at the pairs' poses may be what holds a scan that few motions of its own are told of. One
// that begins as wide as the starts are off leaves nothing out.
constexpr int usual_narrowings = 2;
// Places of the surface at which pulls are added up before their scatter: so many to a scan, enough
// for shared_noise.h to tell from their own what neighbours share.
constexpr double places = 2048;

class Refinement {
 public:
  Refinement(const PreparedScans& scans, std::span<const Pose> poses, std::span<const Pose> guesses,
             const std::vector<bool>& tied, std::size_t anchor, const MultiviewOptions& options);
  void run(double off_m, const Progress& progress);
  JointPoses result();

 private:
  JointFrame frame() const;
  GuessPrior prior() const;
  bool find_pairs(std::vector<JointDetail>* details);
  void settle(int most_rounds, const Progress& progress);
  std::vector<Vector6> damped(std::vector<Vector6> twists);
  bool move(const std::vector<Vector6>& twists);
  void summarise(const std::vector<JointDetail>& details);

  const PreparedScans& scans_;
  std::span<const Pose> guesses_;
  const std::vector<bool>& tied_;
  std::size_t anchor_;
  const MultiviewOptions& options_;
  IcpOptions icp_;
  JointPoses out_;
  std::vector<std::vector<bool>> rims_;  // of each scan
  std::vector<JointCouple> couples_;
  std::vector<JointForm> forms_;
  JointBasis weak_;
  double last_step_ = std::numeric_limits<double>::infinity();
  double step_share_ = 1;
};

Refinement::Refinement(const PreparedScans& scans, std::span<const Pose> poses,
                       std::span<const Pose> guesses, const std::vector<bool>& tied,
                       std::size_t anchor, const MultiviewOptions& options)
    : scans_(scans),
      guesses_(guesses),
      tied_(tied),
      anchor_(anchor),
      options_(options),
      icp_(options.icp) {
  out_.world_from_local.assign(poses.begin(), poses.end());
  out_.scans.resize(poses.size());
  rims_.resize(poses.size());
  parallel_for(
      poses.size(), [&](std::size_t i) { rims_[i] = rim_points(scans.clouds[i]); }, 1);
  std::vector<double> radii_m;
  double reach_m = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!tied[i]) continue;
    radii_m.push_back(scans.clouds[i].radius_m);
    reach_m =
        std::max({reach_m, reach_in_spacings * scans.clouds[i].spacing_m, scans.tolerance_m[i]});
  }
  // Every couple is asked in both directions, by the normals of either: symmetric already.
  if (icp_.method == IcpMethod::symmetric) icp_.method = IcpMethod::point_to_plane;
  if (icp_.max_pair_distance_m == 0) icp_.max_pair_distance_m = reach_m;
  out_.size_m = std::max(median(std::move(radii_m)), std::numeric_limits<double>::min());
  std::vector<std::pair<std::size_t, std::size_t>> overlapping;
  for (const Overlap& one :
       choose_pairs(find_overlaps(scans.clouds, poses, reach_m, icp_.min_overlap), poses.size(),
                    most_partners))
    if (tied[one.source] && tied[one.target]) overlapping.emplace_back(one.source, one.target);
  std::sort(overlapping.begin(), overlapping.end());
  couples_ = joint_couples(overlapping, poses.size(), most_partners);
}

JointFrame Refinement::frame() const {
  JointFrame frame{.centres = {}, .size_m = out_.size_m, .free = tied_};
  frame.free[anchor_] = false;
  for (const Pose& pose : out_.world_from_local) frame.centres.push_back(pose.translation());
  return frame;
}

GuessPrior Refinement::prior() const {
  std::vector<Eigen::Vector3d> scanners;  // the origins of the scans' own frames
  for (std::size_t i = 0; i < guesses_.size(); ++i)
    scanners.push_back(guesses_[i] * Eigen::Vector3d(-scans_.clouds[i].origin));
  return guess_prior(frame(), out_.world_from_local, guesses_, scanners, options_.guess_sigmas,
                     anchor_);
}

// Returns whether all scales follow the residuals. Of many couples one median or another always
// shrinks a little: until none does takes the longer, the more there are, and moves nothing.
bool Refinement::find_pairs(std::vector<JointDetail>* details) {
  std::vector<JointForm> all(couples_.size());
  std::vector<JointDetail> more(details ? couples_.size() : 0);
  const double patch_m = out_.size_m * std::sqrt(4 * std::numbers::pi / places);
  parallel_for(
      couples_.size(),
      [&](std::size_t k) {
        const auto [i, j] = std::pair(couples_[k].source, couples_[k].target);
        all[k] = joint_form(couples_[k], scans_.clouds[i], scans_.clouds[j],
                            out_.world_from_local[i], out_.world_from_local[j], icp_, patch_m,
                            details ? &more[k] : nullptr, rims_[j]);
      },
      1);
  forms_.clear();
  bool settled = true;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].pairs == 0) continue;
    settled = settled && !all[k].narrowing;
    couples_[k].scale_m = all[k].scale_m;
    forms_.push_back(all[k]);
    if (details) details->push_back(std::move(more[k]));
  }
  weak_ = joint_weak_motions(forms_, frame());
  return settled;
}

// A step that has not become smaller goes to and fro between two sets of pairs: then, and while it
// lasts, only a part of it is taken.
std::vector<Vector6> Refinement::damped(std::vector<Vector6> twists) {
  double largest = 0;
  for (const RelativeStep& step : relative_steps(forms_, frame(), twists))
    largest = std::max(largest, std::hypot(step.rotation_rad, step.translation));
  step_share_ = largest < 0.9 * last_step_ ? std::min(1.0, 2 * step_share_) : step_share_ / 2;
  last_step_ = largest;
  for (Vector6& twist : twists) twist *= step_share_;
  return twists;
}

// True if no step mattered.
bool Refinement::move(const std::vector<Vector6>& twists) {
  const std::vector<RelativeStep> steps = relative_steps(forms_, frame(), twists);
  bool all_still = true;
  for (std::size_t i = 0; i < twists.size(); ++i) {
    JointScan& scan = out_.scans[i];
    const bool tiny = steps[i].rotation_rad <= options_.icp.stop_rotation_rad &&
                      steps[i].translation <= options_.icp.stop_translation_fraction;
    scan.still = tiny || steps[i].square <= negligible_square * step_share_ * step_share_;
    all_still = all_still && scan.still;
    if (!twists[i].isZero(0)) ++scan.iterations;
  }
  out_.world_from_local = moved_together(forms_, frame(), out_.world_from_local, twists);
  return all_still;
}

void Refinement::settle(int most_rounds, const Progress& progress) {
  last_step_ = std::numeric_limits<double>::infinity();
  step_share_ = 1;
  for (bool done = false; !done && out_.rounds < most_rounds;) {
    const bool settled = find_pairs(nullptr);
    if (forms_.empty()) break;
    const GuessPrior known = prior();
    std::vector<Vector6> twists = joint_step(forms_, frame(), weak_, known);
    const WayToGuesses way = way_to_guesses(forms_, frame(), weak_, out_.world_from_local, guesses_,
                                            icp_.max_pair_distance_m, known);
    for (std::size_t i = 0; i < twists.size(); ++i) twists[i] += way.twists[i];
    const bool still = move(damped(std::move(twists)));
    done = still && settled && way.whole;
    ++out_.rounds;
    if (options_.on_round) options_.on_round(out_.world_from_local);
    if (progress) progress("refine", double(out_.rounds) / options_.max_rounds);
  }
}

// Welsch's loss pulls the most at its scale: with the first one as wide as the starts are off, the
// few points that hold a slide do so too, and partners count up to three standard deviations off
// (pairs.cpp). From a narrow one these lie beyond it, and the slide comes to rest wherever some
// stray points agree.
void Refinement::run(double off_m, const Progress& progress) {
  const int narrowings = off_m > 0 ? 1 : usual_narrowings;
  for (int narrowing = 1; narrowing <= narrowings; ++narrowing) {
    for (JointCouple& couple : couples_) couple.scale_m = unlimited_m, couple.first_m = off_m;
    settle(options_.max_rounds * narrowing / narrowings, progress);
  }
  std::vector<JointDetail> details;
  find_pairs(&details);
  summarise(details);
  if (progress) progress("refine", 1);
}

void Refinement::summarise(const std::vector<JointDetail>& details) {
  std::vector<std::vector<bool>> paired(out_.scans.size());
  std::vector<double> squares(paired.size(), 0), weights(paired.size(), 0);
  for (std::size_t k = 0; k < forms_.size(); ++k) {
    const JointForm& form = forms_[k];
    paired[form.source].resize(scans_.clouds[form.source].size(), false);
    for (const std::uint32_t i : details[k].paired) paired[form.source][i] = true;
    for (const std::size_t scan : {form.source, form.target}) {
      out_.scans[scan].paired = true;
      squares[scan] += double(form.pairs) * form.rms_m * form.rms_m;
      weights[scan] += double(form.pairs);
    }
    const std::pair couple(std::min(form.source, form.target), std::max(form.source, form.target));
    if (out_.overlapping.empty() || out_.overlapping.back() != couple)
      out_.overlapping.push_back(couple);
  }
  JointCovariances covariances = joint_covariances(forms_, details, frame(), weak_, prior());
  out_.covariances_between = std::move(covariances.between);
  for (std::size_t i = 0; i < paired.size(); ++i) {
    JointScan& scan = out_.scans[i];
    const auto count = static_cast<double>(std::count(paired[i].begin(), paired[i].end(), true));
    scan.paired_fraction = paired[i].empty() ? 0 : count / double(paired[i].size());
    scan.rms_m = weights[i] > 0 ? std::sqrt(squares[i] / weights[i]) : 0;
    scan.weak = weak_motions_of(i, weak_);
    scan.covariance = covariances.of_scan[i];
    scan.covariance_from_guess = covariances.from_guess[i];
    scan.still = scan.still || i == anchor_;
  }
}

JointPoses Refinement::result() {
  return std::move(out_);
}

}  // namespace

JointPoses refine_jointly(const PreparedScans& scans, std::span<const Pose> world_from_local,
                          std::span<const Pose> guesses, const std::vector<bool>& tied,
                          std::size_t anchor, double off_m, const MultiviewOptions& options,
                          const Progress& progress) {
  Refinement refinement(scans, world_from_local, guesses, tied, anchor, options);
  refinement.run(off_m, progress);
  return refinement.result();
}

}  // namespace scan
