// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/exploration.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libscan/align/rotation_grid.h"
#include "libscan/core/parallel.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr std::size_t rotations = 2048;    // the nearest is never 19 degrees off
constexpr std::size_t voting_points = 96;  // of each scan
constexpr std::size_t scored_points = 64;
constexpr std::size_t peaks_per_rotation = 2;
constexpr double bin_in_sides = 4, reach_in_sides = 3;
constexpr double like_normals = 0.9, near_normals = 0.8;  // cosines

struct Sample {
  std::vector<Eigen::Vector3d> points, normals;
};

Sample sample(const PointCloud& cloud, std::size_t count) {
  Sample few;
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / count);
  for (std::size_t i = 0; i < cloud.size() && few.points.size() < count; i += stride) {
    few.points.push_back(cloud.points[i]);
    few.normals.push_back(cloud.normals[i]);
  }
  return few;
}

struct Vote {
  std::array<std::int32_t, 3> bin;
  Eigen::Vector3d translation;
};

// Means of the votes in the fullest bins.
std::vector<Eigen::Vector3d> peaks(std::vector<Vote>& votes) {
  std::stable_sort(votes.begin(), votes.end(),
                   [](const Vote& a, const Vote& b) { return a.bin < b.bin; });
  struct Peak {
    std::size_t count;
    Eigen::Vector3d sum;
  };
  std::vector<Peak> bins;
  for (std::size_t i = 0; i < votes.size(); ++i) {
    if (i == 0 || votes[i].bin != votes[i - 1].bin) bins.push_back({0, Eigen::Vector3d::Zero()});
    ++bins.back().count;
    bins.back().sum += votes[i].translation;
  }
  std::stable_sort(bins.begin(), bins.end(),
                   [](const Peak& a, const Peak& b) { return a.count > b.count; });
  std::vector<Eigen::Vector3d> means;
  for (std::size_t i = 0; i < std::min(bins.size(), peaks_per_rotation); ++i)
    means.push_back(bins[i].sum / static_cast<double>(bins[i].count));
  return means;
}

class Explorer {
 public:
  Explorer(const ScanFeatures& source, const ScanFeatures& target)
      : target_(target.cloud),
        search_(target.cloud.points),
        side_m_(source.side_m),
        source_votes_(sample(source.cloud, voting_points)),
        target_votes_(sample(target.cloud, voting_points)),
        scored_(sample(source.cloud, scored_points)),
        source_centre_(bounds_of(source.cloud.points).center()),
        target_centre_(bounds_of(target.cloud.points).center()) {}

  struct Ranked {
    Pose pose = Pose::Identity();
    double score = 0;
  };

  std::vector<Ranked> try_rotation(const Eigen::Matrix3d& rotation) const {
    std::vector<Vote> votes = votes_of(rotation);
    std::vector<Ranked> found;
    for (const Eigen::Vector3d& translation : peaks(votes)) {
      const Pose pose = make_pose(rotation, translation);
      found.push_back({pose, score(pose)});
    }
    return found;
  }

 private:
  std::vector<Vote> votes_of(const Eigen::Matrix3d& rotation) const {
    std::vector<Vote> votes;
    const double per_bin = 1 / (bin_in_sides * side_m_);
    const Eigen::Vector3d origin = target_centre_ - rotation * source_centre_;
    for (std::size_t i = 0; i < source_votes_.points.size(); ++i) {
      const Eigen::Vector3d x = rotation * source_votes_.points[i];
      const Eigen::Vector3d n = rotation * source_votes_.normals[i];
      for (std::size_t j = 0; j < target_votes_.points.size(); ++j) {
        if (n.dot(target_votes_.normals[j]) < like_normals) continue;
        const Eigen::Vector3d t = target_votes_.points[j] - x;
        const Eigen::Vector3d bin = ((t - origin) * per_bin).array().floor();
        votes.push_back({{static_cast<std::int32_t>(bin.x()), static_cast<std::int32_t>(bin.y()),
                          static_cast<std::int32_t>(bin.z())},
                         t});
      }
    }
    return votes;
  }

  // How near the points come, those within reach whose normals agree.
  double score(const Pose& pose) const {
    const double reach_m = reach_in_sides * side_m_;
    double sum = 0;
    for (std::size_t i = 0; i < scored_.points.size(); ++i) {
      const auto near = search_.nearest(pose * scored_.points[i], reach_m);
      if (near &&
          (pose.linear() * scored_.normals[i]).dot(target_.normals[near->index]) > near_normals)
        sum += 1 - std::sqrt(near->distance2_m2) / reach_m;
    }
    return sum;
  }

  const PointCloud& target_;
  KdTree search_;
  double side_m_;
  Sample source_votes_, target_votes_, scored_;
  Eigen::Vector3d source_centre_, target_centre_;
};

}  // namespace

std::vector<Pose> explore_rotations(const ScanFeatures& source, const ScanFeatures& target,
                                    std::size_t most) {
  const Explorer explorer(source, target);
  const std::vector<Eigen::Quaterniond> grid = rotation_grid(rotations);
  std::vector<std::vector<Explorer::Ranked>> found(grid.size());
  parallel_for(
      grid.size(),
      [&](std::size_t i) { found[i] = explorer.try_rotation(grid[i].toRotationMatrix()); }, 16);
  std::vector<Explorer::Ranked> all;
  for (const auto& few : found) all.insert(all.end(), few.begin(), few.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  if (all.size() > most) all.resize(most);
  std::vector<Pose> poses;
  for (const Explorer::Ranked& one : all) poses.push_back(one.pose);
  return poses;
}

}  // namespace scan
