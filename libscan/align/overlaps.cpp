// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/overlaps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libscan/core/disjoint_sets.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t most_samples = 512;
constexpr double least_cosine = 0.5;

using Cube = std::array<std::int64_t, 3>;

// What one scan has in one cube.
struct Occupant {
  Cube cube;
  std::uint32_t scan = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // sum

  bool shares_place_with(const Occupant& other) const {
    return cube == other.cube && scan == other.scan;
  }
};

Cube cube_of(const Eigen::Vector3d& point, double side_m) {
  Cube cube;
  for (int i = 0; i < 3; ++i)
    cube[std::size_t(i)] = static_cast<std::int64_t>(std::floor(point[i] / side_m));
  return cube;
}

class Occupancy {
 public:
  Occupancy(std::span<const PreparedCloud> scans, std::span<const Pose> poses, double side_m);

  // Per other scan: how many of the scan's samples lie near it.
  std::vector<std::uint32_t> meetings(std::size_t scan) const;

 private:
  std::vector<Occupant> occupants_of(std::size_t scan) const;
  template <class Use>
  void each_at(const Cube& cube, Use&& use) const;

  std::span<const PreparedCloud> scans_;
  std::span<const Pose> poses_;
  double side_m_;
  std::vector<Occupant> occupants_;  // by cube, then by scan
};

std::vector<Occupant> Occupancy::occupants_of(std::size_t scan) const {
  const PreparedCloud& cloud = scans_[scan];
  std::vector<Occupant> all;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    all.push_back({cube_of(poses_[scan] * cloud.points[i], side_m_),
                   static_cast<std::uint32_t>(scan), poses_[scan].linear() * cloud.normals[i]});
  std::stable_sort(all.begin(), all.end(),
                   [](const Occupant& a, const Occupant& b) { return a.cube < b.cube; });
  std::vector<Occupant> merged;
  for (const Occupant& one : all) {
    if (merged.empty() || !merged.back().shares_place_with(one))
      merged.push_back(one);
    else
      merged.back().normal += one.normal;
  }
  return merged;
}

Occupancy::Occupancy(std::span<const PreparedCloud> scans, std::span<const Pose> poses,
                     double side_m)
    : scans_(scans), poses_(poses), side_m_(side_m) {
  std::vector<std::vector<Occupant>> parts(scans.size());
  parallel_for(
      scans.size(), [&](std::size_t i) { parts[i] = occupants_of(i); }, 1);
  for (std::vector<Occupant>& part : parts) {
    for (Occupant& one : part) one.normal.stableNormalize();
    occupants_.insert(occupants_.end(), part.begin(), part.end());
  }
  std::stable_sort(occupants_.begin(), occupants_.end(),
                   [](const Occupant& a, const Occupant& b) { return a.cube < b.cube; });
}

template <class Use>
void Occupancy::each_at(const Cube& cube, Use&& use) const {
  auto at = std::lower_bound(occupants_.begin(), occupants_.end(), cube,
                             [](const Occupant& a, const Cube& b) { return a.cube < b; });
  for (; at != occupants_.end() && at->cube == cube; ++at) use(*at);
}

std::vector<std::uint32_t> Occupancy::meetings(std::size_t scan) const {
  const PreparedCloud& cloud = scans_[scan];
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / most_samples);
  std::vector<std::uint32_t> count(scans_.size(), 0), last(scans_.size(), 0);
  std::uint32_t sample = 0;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    ++sample;
    const Cube middle = cube_of(poses_[scan] * cloud.points[i], side_m_);
    const Eigen::Vector3d normal = poses_[scan].linear() * cloud.normals[i];
    for (int k = 0; k < 27; ++k) {
      const Cube cube = {middle[0] + k / 9 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k % 3 - 1};
      each_at(cube, [&](const Occupant& other) {
        if (last[other.scan] == sample) return;
        const bool known = !normal.isZero(0) && !other.normal.isZero(0);
        if (known && normal.dot(other.normal) < least_cosine) return;
        last[other.scan] = sample;
        ++count[other.scan];
      });
    }
  }
  return count;
}

std::size_t samples_of(const PreparedCloud& cloud) {
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / most_samples);
  return (cloud.size() + stride - 1) / stride;
}

}  // namespace

std::vector<Overlap> find_overlaps(std::span<const PreparedCloud> scans,
                                   std::span<const Pose> world_from_local, double reach_m,
                                   double least_share) {
  if (!(reach_m > 0)) return {};
  const Occupancy occupancy(scans, world_from_local, reach_m);
  std::vector<std::vector<Overlap>> found(scans.size());
  parallel_for(
      scans.size(),
      [&](std::size_t i) {
        const std::vector<std::uint32_t> meetings = occupancy.meetings(i);
        for (std::size_t j = 0; j < scans.size(); ++j)
          if (j != i && meetings[j] > 0)
            found[i].push_back({std::min(i, j), std::max(i, j),
                                meetings[j] / static_cast<double>(samples_of(scans[i]))});
      },
      1);
  std::vector<Overlap> all, merged;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  std::stable_sort(all.begin(), all.end(), [](const Overlap& a, const Overlap& b) {
    return std::pair(a.source, a.target) < std::pair(b.source, b.target);
  });
  for (const Overlap& one : all) {
    const bool again =
        !merged.empty() && merged.back().source == one.source && merged.back().target == one.target;
    if (again)
      merged.back().share = std::max(merged.back().share, one.share);
    else
      merged.push_back(one);
  }
  std::erase_if(merged, [&](const Overlap& one) { return one.share < least_share; });
  return merged;
}

std::vector<Overlap> choose_pairs(std::vector<Overlap> overlaps, std::size_t scans,
                                  std::size_t most_partners) {
  std::stable_sort(overlaps.begin(), overlaps.end(),
                   [](const Overlap& a, const Overlap& b) { return a.share > b.share; });
  DisjointSets chains(scans);
  std::vector<std::size_t> partners(scans, 0);
  std::vector<Overlap> chosen;
  for (const Overlap& one : overlaps) {
    const auto a = static_cast<std::uint32_t>(one.source);
    const auto b = static_cast<std::uint32_t>(one.target);
    if (chains.name_of(a) == chains.name_of(b) &&
        std::min(partners[one.source], partners[one.target]) >= most_partners)
      continue;
    chains.unite(a, b);
    ++partners[one.source], ++partners[one.target];
    chosen.push_back(one);
  }
  return chosen;
}

}  // namespace scan
