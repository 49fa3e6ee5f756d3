// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/multiview.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "libscan/align/agreement.h"
#include "libscan/align/joint_poses.h"
#include "libscan/align/overlaps.h"
#include "libscan/align/prepared_scans.h"
#include "libscan/align/scan_edges.h"
#include "libscan/core/error.h"

namespace scan {
namespace {

constexpr std::size_t least_points = 6;
constexpr double most_off_rotation = 1e-6;  // of any entry
// How far off a guess may put a scan, as a share of its extent.
constexpr double guess_share_of_extent = 0.05;
// Enough for several loops through each scan.
constexpr std::size_t most_partners = 8;
// Pairs that failed or disagreed are tried again from the poses of the others.
constexpr int most_passes = 3;

// Rounding is repaired; what is further from a rotation mirrors, stretches or shears the scan.
void check_guess(const Pose& guess, std::size_t i) {
  const std::string name = "align_scans: guess " + std::to_string(i);
  if (!guess.matrix().allFinite()) throw Error(Trouble::input, name + " is not finite");
  if (guess.linear().determinant() < 0)
    throw Error(Trouble::input, name + " is left-handed: it mirrors the scan");
  const double off = (guess.linear() - nearest_rotation(guess.linear())).cwiseAbs().maxCoeff();
  if (off > most_off_rotation)
    throw Error(Trouble::input, name + ": its matrix is " + std::to_string(off) +
                                    " away from a rotation, must be 1e-6 at most");
}

// Turn and shift are known of each scan against the anchor, and none exactly.
void check_sigmas(const MultiviewOptions& options, std::size_t scans) {
  const std::vector<GuessSigma>& sigmas = options.guess_sigmas;
  if (sigmas.empty()) return;
  if (sigmas.size() != scans)
    throw Error(Trouble::usage, "align_scans: guess_sigmas: " + std::to_string(sigmas.size()) +
                                    " for " + std::to_string(scans) + " scans");
  const GuessSigma& anchor = sigmas[static_cast<std::size_t>(options.anchor)];
  const auto fits = [](double own, double of_anchor, bool is_anchor) {
    return std::isfinite(own) && own >= 0 && (is_anchor || own + of_anchor > 0);
  };
  for (std::size_t i = 0; i < scans; ++i) {
    const bool is_anchor = i == static_cast<std::size_t>(options.anchor);
    if (!fits(sigmas[i].rotation_rad, anchor.rotation_rad, is_anchor) ||
        !fits(sigmas[i].translation_m, anchor.translation_m, is_anchor))
      throw Error(Trouble::usage, "align_scans: guess_sigmas: of scan " + std::to_string(i) +
                                      ", must be finite and positive");
  }
}

void check_input(std::span<const PointCloud> clouds, std::span<const Pose> guesses,
                 const MultiviewOptions& options) {
  check(options);
  if (clouds.size() != guesses.size())
    throw Error(Trouble::input, "align_scans: " + std::to_string(clouds.size()) + " scans, " +
                                    std::to_string(guesses.size()) + " guesses; must be equal");
  if (!clouds.empty() && static_cast<std::size_t>(options.anchor) >= clouds.size())
    throw Error(Trouble::usage, "align_scans: anchor: " + std::to_string(options.anchor) +
                                    ", must be below " + std::to_string(clouds.size()));
  check_sigmas(options, clouds.size());
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    check(clouds[i]);
    if (!clouds[i].empty() && clouds[i].normals.empty())
      throw Error(Trouble::input, "align_scans: scan " + std::to_string(i) + " has no normals",
                  "estimate normals first");
    check_guess(guesses[i], i);
  }
}

double extent_m(const PreparedCloud& cloud) {
  const Bounds box = bounds_of(cloud.points);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

// Where among the edges the one of a source and a target stands.
using EdgePlaces = std::map<std::pair<std::size_t, std::size_t>, std::size_t>;

// Alignment of all scans, in a frame that is the world moved to `origin_`.
class Alignment {
 public:
  Alignment(std::span<const PointCloud> clouds, std::span<const Pose> guesses,
            const MultiviewOptions& options, const Progress& progress);
  MultiviewResult run();

 private:
  void find_poses();
  std::vector<EdgeTask> open_pairs(const EdgePlaces& tried) const;
  Pose relative(std::size_t source, std::size_t target) const;
  bool is_done(const ScanEdge& edge, const EdgeTask& task) const;
  void solve();
  void refine();
  std::vector<Pose> world_poses(std::span<const Pose> world_from_local) const;
  void report(const JointPoses& joint);
  void measure_agreement(const JointPoses& joint);
  Stop overall() const;

  const MultiviewOptions& options_;
  const Progress& progress_;
  std::size_t anchor_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  PreparedScans scans_;
  double guess_reach_m_ = 0;
  std::vector<Pose> poses_, guesses_;  // of the prepared points
  std::vector<bool> tied_;
  MultiviewResult result_;
};

Alignment::Alignment(std::span<const PointCloud> clouds, std::span<const Pose> guesses,
                     const MultiviewOptions& options, const Progress& progress)
    : options_(options),
      progress_(progress),
      anchor_(static_cast<std::size_t>(options.anchor)),
      scans_(prepare_scans(clouds, options)),
      tied_(clouds.size(), false) {
  origin_ = guesses[anchor_] * scans_.clouds[anchor_].origin;
  result_.scans.resize(clouds.size());
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const Pose guess = with_proper_rotation(guesses[i]);
    result_.scans[i].world_from_scan = guess;
    poses_.push_back(make_pose(guess.linear(), guess * scans_.clouds[i].origin - origin_));
    guess_reach_m_ = std::max(guess_reach_m_, guess_share_of_extent * extent_m(scans_.clouds[i]));
    const bool enough = scans_.clouds[i].size() >= least_points;
    result_.scans[i].stop = enough ? Stop::no_correspondences : Stop::too_few_points;
  }
  guesses_ = poses_;
}

Pose Alignment::relative(std::size_t source, std::size_t target) const {
  return global_pose(poses_[target].inverse() * poses_[source], scans_.clouds[source],
                     scans_.clouds[target]);
}

// Accepted, or tried from nearly the same guess.
bool Alignment::is_done(const ScanEdge& edge, const EdgeTask& task) const {
  const PreparedCloud& source = scans_.clouds[task.source];
  const Pose& before = edge.target_from_source_guess;
  const double moved_m =
      (before * source.origin - task.target_from_source_guess * source.origin).norm() +
      source.radius_m * rotation_distance_rad(before, task.target_from_source_guess);
  return edge.accepted || moved_m < source.spacing_m;
}

// Pairs that overlap at the present poses and are not done.
std::vector<EdgeTask> Alignment::open_pairs(const EdgePlaces& tried) const {
  std::vector<EdgeTask> tasks;
  const auto overlaps =
      find_overlaps(scans_.clouds, poses_, guess_reach_m_, options_.icp.min_overlap);
  for (const Overlap& overlap : choose_pairs(overlaps, poses_.size(), most_partners)) {
    const EdgeTask task{overlap.source, overlap.target, relative(overlap.source, overlap.target)};
    const auto before = tried.find({task.source, task.target});
    if (before == tried.end() || !is_done(result_.edges[before->second], task))
      tasks.push_back(task);
  }
  return tasks;
}

void Alignment::solve() {
  SolvedPoses solved =
      solve_edges(scans_, poses_, result_.edges, anchor_, {guesses_, options_.guess_sigmas});
  poses_ = std::move(solved.world_from_local);
  tied_ = std::move(solved.tied);
}

void Alignment::find_poses() {
  EdgePlaces places;
  for (int pass = 0; pass < most_passes; ++pass) {
    const std::vector<EdgeTask> tasks = open_pairs(places);
    if (tasks.empty()) break;
    for (const ScanEdge& edge : align_pairs(scans_, tasks, options_, progress_)) {
      const auto [place, is_new] =
          places.try_emplace({edge.source, edge.target}, result_.edges.size());
      if (is_new)
        result_.edges.push_back(edge);
      else
        result_.edges[place->second] = edge;
    }
    solve();
  }
  std::sort(result_.edges.begin(), result_.edges.end(), [](const ScanEdge& a, const ScanEdge& b) {
    return std::pair(a.source, a.target) < std::pair(b.source, b.target);
  });
}

// Of the scans' own points, in the world where the guesses are.
std::vector<Pose> Alignment::world_poses(std::span<const Pose> world_from_local) const {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < world_from_local.size(); ++i) {
    const Pose& pose = world_from_local[i];
    poses.push_back(make_pose(
        pose.linear(), origin_ + pose.translation() - pose.linear() * scans_.clouds[i].origin));
  }
  return poses;
}

void Alignment::refine() {
  MultiviewOptions options = options_;
  if (options_.on_round) {
    options_.on_round(world_poses(poses_));
    options.on_round = [&](std::span<const Pose> local) { options_.on_round(world_poses(local)); };
  }
  JointPoses joint = refine_jointly(scans_, poses_, guesses_, tied_, anchor_,
                                    open_sigma_m(scans_, result_.edges), options, progress_);
  poses_ = joint.world_from_local;
  result_.rounds = joint.rounds;
  result_.pairs_used = joint.overlapping.size();
  result_.covariances_between = joint.covariances_between;
  report(joint);
  measure_agreement(joint);
}

void Alignment::report(const JointPoses& joint) {
  const std::vector<Pose> world = world_poses(poses_);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const JointScan& found = joint.scans[i];
    ScanPose& scan = result_.scans[i];
    if (!found.paired) continue;
    scan.rms_m = found.rms_m;
    scan.inlier_fraction_of_source = found.paired_fraction;
    scan.iterations = found.iterations;
    scan.covariance = found.covariance;
    scan.covariance_from_guess = found.covariance_from_guess;
    scan.covariance_centre = origin_ + poses_[i].translation();
    const DataFrame frame{poses_[i].translation(), joint.size_m};
    scan.weak_directions = name_motions(found.weak, frame, origin_);
    scan.stop = !found.still            ? Stop::iteration_limit
                : found.weak.cols() > 0 ? Stop::degenerate
                                        : Stop::converged;
    if (i != anchor_) scan.world_from_scan = world[i];
  }
}

// How well each scan lies on those that it meets, at the final poses.
void Alignment::measure_agreement(const JointPoses& joint) {
  std::vector<std::vector<PosedScan>> others(poses_.size());
  const auto posed = [&](std::size_t i) {
    return PosedScan{&scans_.clouds[i], poses_[i], scans_.tolerance_m[i]};
  };
  for (const auto& [i, j] : joint.overlapping) {
    others[i].push_back(posed(j));
    others[j].push_back(posed(i));
  }
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const double reach_m = guess_share_of_extent * extent_m(scans_.clouds[i]);
    result_.scans[i].agreement = agreement(posed(i), others[i], reach_m).agreeing;
  }
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
  if (result_.scans[anchor_].stop != Stop::too_few_points) {
    find_poses();
    if (poses_.size() == 1) result_.scans[anchor_].stop = Stop::converged;
    if (std::count(tied_.begin(), tied_.end(), true) > 1) refine();
    for (ScanEdge& edge : result_.edges)
      edge.accepted = edge.accepted && within_guess(scans_, edge, poses_);
  }
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
  result.cost.seconds = watch.seconds();
  return result;
}

}  // namespace scan
