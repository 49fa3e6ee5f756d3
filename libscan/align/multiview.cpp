// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/multiview.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "libscan/align/agreement.h"
#include "libscan/align/placement.h"
#include "libscan/align/scan_pairs.h"
#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/search/voxel_grid.h"

namespace scan {
namespace {

using PreparedScans = std::vector<std::unique_ptr<PreparedScan>>;
constexpr std::size_t least_points = 6;
// Thinning keeps about every fourth point of a surface.
constexpr double thin_in_spacings = 2;
// Partners may be this many spacings of the thinned scans, or residuals after placing, apart.
constexpr double gate_in_spacings = 3;
constexpr double most_sigma_in_medians = 2;

void check_input(std::span<const PointCloud> clouds, std::span<const Pose> guesses,
                 const MultiviewOptions& options) {
  check(options);
  if (clouds.size() != guesses.size())
    throw Error(Trouble::input, "align_scans: " + std::to_string(clouds.size()) + " scans, " +
                                    std::to_string(guesses.size()) + " guesses; must be equal");
  if (!clouds.empty() && static_cast<std::size_t>(options.anchor) >= clouds.size())
    throw Error(Trouble::usage, "align_scans: anchor: " + std::to_string(options.anchor) +
                                    ", must be below " + std::to_string(clouds.size()));
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    check(clouds[i]);
    if (!clouds[i].empty() && clouds[i].normals.empty())
      throw Error(Trouble::input, "align_scans: scan " + std::to_string(i) + " has no normals",
                  "estimate normals first");
    if (!guesses[i].matrix().allFinite())
      throw Error(Trouble::input, "align_scans: guess " + std::to_string(i) + " is not finite");
  }
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Without the points whose sigma is more than twice the scan's median: readings at grazing
// incidence, which slide along the surface rather than off it and bend the normals around them.
PointCloud without_weak_points(PointCloud cloud) {
  if (cloud.sigma_m.empty()) return cloud;
  const double limit_m = most_sigma_in_medians * median(cloud.sigma_m);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (cloud.sigma_m[i] <= limit_m) kept.push_back(i);
  return subset(cloud, kept);
}

// Alignment of all scans, in a frame that is the world moved to `origin_`.
class Alignment {
 public:
  Alignment(std::span<const PointCloud> clouds, std::span<const Pose> guesses,
            const MultiviewOptions& options, const Progress& progress);
  MultiviewResult run();

 private:
  void prepare();
  double thinning_side_m(const std::vector<PointCloud>& finite) const;
  void place();
  void refine();
  std::vector<ScanCouple> placed_couples() const;
  DataFrame shared_frame() const;
  JointGates first_gates() const;
  std::vector<Vector6> joint_step(const JointPairs& pairs, const DataFrame& frame);
  bool move_scans(const std::vector<Vector6>& twists, const DataFrame& frame);
  void judge(const JointPairs& pairs, const DataFrame& frame);
  void judge_scan(std::size_t i, const JointPairs& pairs, const DataFrame& frame);
  void measure_agreement();
  Stop overall() const;

  std::span<const PointCloud> clouds_;
  const MultiviewOptions& options_;
  const Progress& progress_;
  std::size_t anchor_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  PreparedScans scans_;
  std::vector<bool> placed_;
  std::vector<bool> still_;  // moved less than the tolerances in the last round
  double last_step_ = std::numeric_limits<double>::infinity();
  double step_share_ = 1;
  MultiviewResult result_;
};

Alignment::Alignment(std::span<const PointCloud> clouds, std::span<const Pose> guesses,
                     const MultiviewOptions& options, const Progress& progress)
    : clouds_(clouds),
      options_(options),
      progress_(progress),
      anchor_(static_cast<std::size_t>(options.anchor)),
      placed_(clouds.size(), false),
      still_(clouds.size(), false) {
  result_.scans.resize(clouds.size());
  origin_ = guesses[anchor_].translation();
  const Bounds box = bounds_of(clouds[anchor_].points);
  if (!box.isEmpty()) origin_ = guesses[anchor_] * box.center();
  for (std::size_t i = 0; i < clouds.size(); ++i)
    result_.scans[i].world_from_scan =
        Eigen::Translation3d(-origin_) * with_proper_rotation(guesses[i]);
}

double Alignment::thinning_side_m(const std::vector<PointCloud>& finite) const {
  if (options_.thin_m > 0) return options_.thin_m;
  std::vector<double> spacings(finite.size());
  parallel_for(
      finite.size(),
      [&](std::size_t i) { spacings[i] = spacing_m(finite[i].points, KdTree(finite[i].points)); },
      1);
  std::erase(spacings, 0);
  return thin_in_spacings * median(std::move(spacings));
}

void Alignment::prepare() {
  std::vector<PointCloud> finite;
  for (const PointCloud& cloud : clouds_)
    finite.push_back(without_weak_points(subset(cloud, finite_points(cloud))));
  const double side_m = thinning_side_m(finite);
  scans_.resize(finite.size());
  parallel_for(
      finite.size(),
      [&](std::size_t i) {
        scans_[i] = std::make_unique<PreparedScan>(side_m > 0 && !finite[i].empty()
                                                       ? voxel_grid(finite[i], side_m)
                                                       : std::move(finite[i]));
      },
      1);
}

void Alignment::place() {
  std::vector<PointCloud> clouds;
  std::vector<KdTree> searches;
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    clouds.push_back(scans_[i]->cloud);
    searches.emplace_back(scans_[i]->cloud.points);
    const bool enough = scans_[i]->cloud.size() >= least_points;
    result_.scans[i].stop = enough ? Stop::no_correspondences : Stop::too_few_points;
  }
  if (result_.scans[anchor_].stop == Stop::too_few_points) return;
  placed_[anchor_] = true;
  place_in_turn(clouds, searches, options_, progress_, result_.scans, placed_);
}

DataFrame Alignment::shared_frame() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0, sum2 = 0;
  const auto each_point = [&](auto&& use) {
    for (std::size_t i = 0; i < scans_.size(); ++i)
      if (placed_[i])
        for (const Eigen::Vector3d& x : scans_[i]->cloud.points)
          use(result_.scans[i].world_from_scan * x);
  };
  each_point([&](const Eigen::Vector3d& x) { sum += x, ++count; });
  const Eigen::Vector3d centre = sum / count;
  each_point([&](const Eigen::Vector3d& x) { sum2 += (x - centre).squaredNorm(); });
  return {centre, sum2 > 0 ? std::sqrt(sum2 / count) : 1};
}

JointGates Alignment::first_gates() const {
  double largest_m = 0;
  for (std::size_t i = 0; i < scans_.size(); ++i)
    if (placed_[i]) largest_m = std::max({largest_m, scans_[i]->spacing_m, result_.scans[i].rms_m});
  const double given_m = options_.icp.max_pair_distance_m;
  return {.distance_m = given_m > 0 ? given_m : gate_in_spacings * largest_m,
          .least_cosine = std::cos(options_.icp.max_normal_angle_rad),
          .min_overlap = options_.min_overlap};
}

// The twists of all scans about the frame's centre, in its units. A step that has not become
// smaller goes to and fro between two sets of pairs: then, and while it lasts, only a part of it is
// taken.
std::vector<Vector6> Alignment::joint_step(const JointPairs& pairs, const DataFrame& frame) {
  std::vector<bool> fixed(scans_.size(), true);
  for (const ScanPairForm& form : pairs.forms) fixed[form.source] = fixed[form.target] = false;
  fixed[anchor_] = true;
  std::vector<Vector6> twists = solve_forms(pairs.forms, scans_.size(), fixed);
  double largest = 0;
  for (const Vector6& twist : twists) largest = std::max(largest, twist.norm());
  step_share_ = largest < 0.9 * last_step_ ? std::min(1.0, 2 * step_share_) : step_share_ / 2;
  last_step_ = largest;
  for (Vector6& twist : twists) twist *= step_share_;
  for (Vector6& twist : twists) twist.tail<3>() *= frame.size_m;
  return twists;
}

// True if no scan moved beyond the tolerances.
bool Alignment::move_scans(const std::vector<Vector6>& twists, const DataFrame& frame) {
  bool all_still = true;
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    const Vector6& twist = twists[i];
    still_[i] = twist.head<3>().norm() < options_.icp.stop_rotation_rad &&
                twist.tail<3>().norm() < options_.icp.stop_translation_fraction * 2 * frame.size_m;
    all_still = all_still && still_[i];
    if (twist.isZero(0)) continue;
    const Eigen::Vector3d& c = frame.centre;
    ScanPose& scan = result_.scans[i];
    const Pose moved =
        Eigen::Translation3d(c) * exp(twist) * Eigen::Translation3d(-c) * scan.world_from_scan;
    scan.world_from_scan = make_pose(nearest_rotation(moved.linear()), moved.translation());
    ++scan.iterations;
  }
  return all_still;
}

std::vector<ScanCouple> Alignment::placed_couples() const {
  std::vector<ScanCouple> couples;
  for (std::size_t i = 0; i < scans_.size(); ++i)
    for (std::size_t j = i + 1; j < scans_.size(); ++j)
      if (placed_[i] && placed_[j]) couples.emplace_back(i, j);
  return couples;
}

void Alignment::refine() {
  const DataFrame frame = shared_frame();
  JointGates gates = first_gates();
  JointPairs pairs;
  pairs.couples = placed_couples();
  for (bool done = false; !done;) {
    std::vector<Pose> poses;
    for (const ScanPose& scan : result_.scans) poses.push_back(scan.world_from_scan);
    pairs = pair_scans(scans_, poses, pairs.couples, frame, gates);
    gates.tukey_limit_m = pairs.tukey_limit_m;
    if (pairs.forms.empty() || result_.rounds == options_.max_rounds) break;
    done = move_scans(joint_step(pairs, frame), frame);
    ++result_.rounds;
    if (progress_) progress_("refine", double(result_.rounds) / options_.max_rounds);
  }
  if (progress_) progress_("refine", 1);
  result_.pairs_used = pairs.forms.size() / 2;
  judge(pairs, frame);
}

// What the joint step says of one scan, the others held.
void Alignment::judge_scan(std::size_t i, const JointPairs& pairs, const DataFrame& frame) {
  Matrix6 information = Matrix6::Zero();
  for (const ScanPairForm& form : pairs.forms)
    if (form.source == i || form.target == i) information += form.a;
  if (information.isZero(0)) return;  // in no joint pair: what placing said holds
  ScanPose& scan = result_.scans[i];
  scan.rms_m = pairs.rms_m[i];
  scan.inlier_fraction_of_source = pairs.paired_fraction[i];
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(information);
  const Eigen::Index open = (solver.eigenvalues().array() < 1e-9 * solver.eigenvalues()[5]).count();
  scan.weak_directions = name_motions(solver.eigenvectors().leftCols(open), frame, origin_);
  scan.stop = !still_[i] ? Stop::iteration_limit : open > 0 ? Stop::degenerate : Stop::converged;
}

// How well each scan lies on all others, at the final poses.
void Alignment::measure_agreement() {
  std::vector<PosedScan> posed(scans_.size());
  parallel_for(
      scans_.size(),
      [&](std::size_t i) {
        const PreparedScan& scan = *scans_[i];
        posed[i] = {&scan.cloud, &scan.search, result_.scans[i].world_from_scan,
                    tolerated_residual_m(scan.cloud, scan.search)};
      },
      1);
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    if (!placed_[i]) continue;
    std::vector<PosedScan> others;
    for (std::size_t j = 0; j < scans_.size(); ++j)
      if (placed_[j] && j != i) others.push_back(posed[j]);
    result_.scans[i].agreement =
        agreement(posed[i], others, overlap_reach_m(*posed[i].cloud)).agreeing;
  }
}

void Alignment::judge(const JointPairs& pairs, const DataFrame& frame) {
  for (std::size_t i = 0; i < scans_.size(); ++i)
    if (placed_[i] && i != anchor_) judge_scan(i, pairs, frame);
  ScanPose& anchor = result_.scans[anchor_];
  anchor.stop =
      pairs.forms.empty() && scans_.size() > 1 ? Stop::no_correspondences : Stop::converged;
  anchor.rms_m = pairs.rms_m[anchor_];
  anchor.inlier_fraction_of_source = pairs.paired_fraction[anchor_];
  measure_agreement();
}

// Converged if all scans are; else the gravest of their reasons.
Stop Alignment::overall() const {
  for (const Stop stop :
       {Stop::too_few_points, Stop::no_correspondences, Stop::degenerate, Stop::iteration_limit})
    for (const ScanPose& scan : result_.scans)
      if (scan.stop == stop) return stop;
  return Stop::converged;
}

MultiviewResult Alignment::run() {
  prepare();
  place();
  if (placed_[anchor_]) refine();
  for (ScanPose& scan : result_.scans) scan.world_from_scan.translation() += origin_;
  result_.stop = overall();
  return std::move(result_);
}

}  // namespace

MultiviewResult align_scans(std::span<const PointCloud> clouds, std::span<const Pose> guesses,
                            const MultiviewOptions& options, const Progress& progress) {
  const Stopwatch watch;
  check_input(clouds, guesses, options);
  if (clouds.empty()) return {};
  MultiviewResult result = Alignment(clouds, guesses, options, progress).run();
  for (std::size_t i = 0; i < guesses.size(); ++i)  // untouched poses keep their bits
    if (result.scans[i].stop == Stop::too_few_points ||
        result.scans[i].stop == Stop::no_correspondences || i == std::size_t(options.anchor))
      result.scans[i].world_from_scan = with_proper_rotation(guesses[i]);
  result.cost.seconds = watch.seconds();
  return result;
}

}  // namespace scan
