// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/placement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "libscan/align/agreement.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t most_samples = 512;
// How far off a guess may put a scan and still be told from one that does not overlap.
constexpr double guess_share_of_extent = 0.05;
// With less, other starts are tried as well.
constexpr double good_agreement = 0.8;

double extent_m(const PointCloud& cloud) {
  const Bounds box = bounds_of(cloud.points);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

// The unplaced scan that overlaps most with the placed ones, given that it passes the limit.
struct Candidate {
  std::size_t scan = 0;
  double overlap = 0;
};

// The guess turned about the middle of the cloud, and shifted, both ways along each axis; a turn
// moves the ends of the cloud by about as much as a shift.
std::vector<Pose> starts_around(const Pose& guess, const PointCloud& cloud, double shift_m) {
  const Bounds box = bounds_of(cloud.points);
  const Eigen::Vector3d centre = guess * box.center();
  const double angle_rad = shift_m / (0.5 * box.diagonal().norm());
  std::vector<Pose> starts;
  for (int i = 0; i < 6; ++i)
    for (const double sign : {-1.0, 1.0}) {
      Vector6 twist = Vector6::Zero();
      twist[i] = sign * (i < 3 ? angle_rad : shift_m);
      starts.push_back(Eigen::Translation3d(centre) * exp(twist) * Eigen::Translation3d(-centre) *
                       guess);
    }
  return starts;
}

class Placement {
 public:
  Placement(std::span<const PointCloud> clouds, std::span<const KdTree> searches,
            const MultiviewOptions& options, std::vector<ScanPose>& scans,
            std::vector<bool>& placed)
      : clouds_(clouds), searches_(searches), options_(options), scans_(scans), placed_(placed) {
    for (std::size_t i = 0; i < clouds.size(); ++i)
      tolerances_m_.push_back(tolerated_residual_m(clouds[i], searches[i]));
  }

  void run(const Progress& progress);

 private:
  // A scan aligned from one start, and the share of its points that then agree with what is placed.
  struct Attempt {
    IcpResult icp;
    Agreement agreement;
    double score() const { return agreement.expected * agreement.agreeing; }
  };

  std::optional<Candidate> next(const std::vector<bool>& refused) const;
  double overlap_with_placed(std::size_t scan) const;
  double reach_m(std::size_t scan) const { return overlap_reach_m(clouds_[scan]); }
  PointCloud placed_points() const;
  Attempt attempt(std::size_t scan, const PointCloud& world, const Pose& start) const;
  Attempt best_attempt(std::size_t scan) const;
  bool add(std::size_t scan);

  std::span<const PointCloud> clouds_;
  std::span<const KdTree> searches_;
  const MultiviewOptions& options_;
  std::vector<ScanPose>& scans_;
  std::vector<bool>& placed_;
  std::vector<double> tolerances_m_;
};

// Sum over the placed scans: a scan that two of them see is fixed better than by one.
double Placement::overlap_with_placed(std::size_t scan) const {
  double sum = 0;
  for (std::size_t j = 0; j < clouds_.size(); ++j)
    if (placed_[j])
      sum += predicted_overlap(clouds_[scan], scans_[scan].world_from_scan, clouds_[j],
                               searches_[j], scans_[j].world_from_scan, reach_m(scan));
  return sum;
}

std::optional<Candidate> Placement::next(const std::vector<bool>& refused) const {
  std::vector<double> overlaps(clouds_.size(), -1);
  parallel_for(
      clouds_.size(),
      [&](std::size_t i) {
        if (!placed_[i] && !refused[i]) overlaps[i] = overlap_with_placed(i);
      },
      1);
  const auto best = std::max_element(overlaps.begin(), overlaps.end());
  if (!(*best >= options_.min_overlap)) return std::nullopt;
  return Candidate{static_cast<std::size_t>(best - overlaps.begin()), *best};
}

PointCloud Placement::placed_points() const {
  PointCloud world;
  for (std::size_t j = 0; j < clouds_.size(); ++j) {
    if (!placed_[j]) continue;
    PointCloud moved = transformed(scans_[j].world_from_scan, clouds_[j]);
    if (world.empty())
      world = std::move(moved);
    else
      append(world, moved);
  }
  return world;
}

Placement::Attempt Placement::attempt(std::size_t scan, const PointCloud& world,
                                      const Pose& start) const {
  Attempt attempt{icp(clouds_[scan], world, start, options_.icp), {}};
  std::vector<PosedScan> others;
  for (std::size_t j = 0; j < clouds_.size(); ++j)
    if (placed_[j])
      others.push_back({&clouds_[j], &searches_[j], scans_[j].world_from_scan, tolerances_m_[j]});
  const PosedScan posed{&clouds_[scan], &searches_[scan], attempt.icp.target_from_source,
                        tolerances_m_[scan]};
  attempt.agreement = agreement(posed, others, reach_m(scan));
  return attempt;
}

// From the guess; where that does not end well, from starts around it too.
Placement::Attempt Placement::best_attempt(std::size_t scan) const {
  const PointCloud world = placed_points();
  const Pose& guess = scans_[scan].world_from_scan;
  Attempt best = attempt(scan, world, guess);
  if (best.agreement.agreeing >= good_agreement) return best;
  for (const Pose& start : starts_around(guess, clouds_[scan], reach_m(scan))) {
    Attempt other = attempt(scan, world, start);
    if (other.score() > best.score()) best = std::move(other);
  }
  return best;
}

bool Placement::add(std::size_t scan) {
  ScanPose& pose = scans_[scan];
  const Attempt best = best_attempt(scan);
  const IcpResult& result = best.icp;
  pose.iterations += result.iterations;
  pose.stop = result.stop;
  pose.agreement = best.agreement.agreeing;
  if (result.stop == Stop::no_correspondences || result.stop == Stop::too_few_points) return false;
  if (result.inlier_fraction_of_source < options_.min_overlap) {
    pose.stop = Stop::no_correspondences;
    return false;
  }
  pose.world_from_scan = result.target_from_source;
  pose.rms_m = result.rms_m;
  pose.inlier_fraction_of_source = result.inlier_fraction_of_source;
  pose.weak_directions = result.weak_directions;
  return true;
}

void Placement::run(const Progress& progress) {
  // A refused scan is tried again once another one has been placed.
  std::vector<bool> refused(clouds_.size(), false);
  double done = 0;
  while (const std::optional<Candidate> candidate = next(refused)) {
    if (add(candidate->scan)) {
      placed_[candidate->scan] = true;
      std::fill(refused.begin(), refused.end(), false);
      if (progress) progress("place", ++done / static_cast<double>(clouds_.size() - 1));
    } else {
      refused[candidate->scan] = true;
    }
  }
}

}  // namespace

double overlap_reach_m(const PointCloud& cloud) {
  return guess_share_of_extent * extent_m(cloud);
}

double predicted_overlap(const PointCloud& a, const Pose& world_from_a, const PointCloud& b,
                         const KdTree& b_search, const Pose& world_from_b, double distance_m) {
  if (a.empty() || b.empty()) return 0;
  const Pose b_from_a = world_from_b.inverse() * world_from_a;
  const std::size_t stride = std::max<std::size_t>(1, a.size() / most_samples);
  std::size_t near = 0, tried = 0;
  for (std::size_t i = 0; i < a.size(); i += stride, ++tried) {
    const auto found = b_search.nearest(b_from_a * a.points[i], distance_m);
    if (!found) continue;
    const bool known = !a.normals.empty() && !b.normals.empty() && !a.normals[i].isZero() &&
                       !b.normals[found->index].isZero();
    if (!known || (b_from_a.linear() * a.normals[i]).dot(b.normals[found->index]) > 0.5) ++near;
  }
  return static_cast<double>(near) / static_cast<double>(tried);
}

void place_in_turn(std::span<const PointCloud> clouds, std::span<const KdTree> searches,
                   const MultiviewOptions& options, const Progress& progress,
                   std::vector<ScanPose>& scans, std::vector<bool>& placed) {
  Placement(clouds, searches, options, scans, placed).run(progress);
}

}  // namespace scan
