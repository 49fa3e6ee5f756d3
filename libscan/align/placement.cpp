// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/placement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t most_samples = 512;
// How far off a guess may put a scan and still be told from one that does not overlap.
constexpr double guess_share_of_extent = 0.05;

double extent_m(const PointCloud& cloud) {
  const Bounds box = bounds_of(cloud.points);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

// The unplaced scan that overlaps most with the placed ones, given that it passes the limit.
struct Candidate {
  std::size_t scan = 0;
  double overlap = 0;
};

class Placement {
 public:
  Placement(std::span<const PointCloud> clouds, std::span<const KdTree> searches,
            const MultiviewOptions& options, std::vector<ScanPose>& scans, std::vector<bool>& placed)
      : clouds_(clouds), searches_(searches), options_(options), scans_(scans), placed_(placed) {}

  void run(const Progress& progress);

 private:
  std::optional<Candidate> next(const std::vector<bool>& refused) const;
  double overlap_with_placed(std::size_t scan) const;
  bool add(std::size_t scan);

  std::span<const PointCloud> clouds_;
  std::span<const KdTree> searches_;
  const MultiviewOptions& options_;
  std::vector<ScanPose>& scans_;
  std::vector<bool>& placed_;
};

// Sum over the placed scans: a scan that two of them see is fixed better than by one.
double Placement::overlap_with_placed(std::size_t scan) const {
  const double distance_m = guess_share_of_extent * extent_m(clouds_[scan]);
  double sum = 0;
  for (std::size_t j = 0; j < clouds_.size(); ++j)
    if (placed_[j])
      sum += predicted_overlap(clouds_[scan], scans_[scan].world_from_scan, clouds_[j], searches_[j],
                               scans_[j].world_from_scan, distance_m);
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

bool Placement::add(std::size_t scan) {
  PointCloud world;
  for (std::size_t j = 0; j < clouds_.size(); ++j) {
    if (!placed_[j]) continue;
    PointCloud moved = transformed(scans_[j].world_from_scan, clouds_[j]);
    if (world.empty())
      world = std::move(moved);
    else
      append(world, moved);
  }
  ScanPose& pose = scans_[scan];
  const IcpResult result = icp(clouds_[scan], world, pose.world_from_scan, options_.icp);
  pose.iterations += result.iterations;
  pose.stop = result.stop;
  const bool moved = result.stop != Stop::no_correspondences && result.stop != Stop::too_few_points;
  if (!moved || result.inlier_fraction_of_source < options_.min_overlap) {
    pose.stop = moved ? Stop::no_correspondences : result.stop;
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
