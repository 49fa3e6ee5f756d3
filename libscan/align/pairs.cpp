// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/pairs.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t chunk = 1024;
// The gate in median pair distances; a normal distribution has 96 % below three medians.
constexpr double gate_in_medians = 3;

// The value below which `share` of them lie; reorders them.
double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const double place = std::ceil(share * static_cast<double>(values.size())) - 1;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(0.0, place));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

LocalCloud localise(const PointCloud& cloud) {
  check(cloud);
  LocalCloud local;
  const std::vector<std::uint32_t> valid = finite_points(cloud);
  local.invalid_points = cloud.size() - valid.size();
  if (valid.empty()) return local;
  const Eigen::Vector3d& first = cloud.points[valid[0]];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : valid) sum += cloud.points[i] - first;
  local.origin = first + sum / static_cast<double>(valid.size());
  double sum2 = 0;
  for (const std::uint32_t i : valid) {
    local.points.push_back(cloud.points[i] - local.origin);
    sum2 += local.points.back().squaredNorm();
    if (!cloud.normals.empty()) local.normals.push_back(cloud.normals[i].normalized());
  }
  local.radius_m = std::sqrt(sum2 / static_cast<double>(valid.size()));
  return local;
}

Pose local_pose(const Pose& target_from_source, const LocalCloud& source, const LocalCloud& target) {
  return make_pose(target_from_source.linear(), target_from_source * source.origin - target.origin);
}

Pose global_pose(const Pose& local, const LocalCloud& source, const LocalCloud& target) {
  return make_pose(local.linear(),
                   target.origin + local.translation() - local.linear() * source.origin);
}

PairFinder::PairFinder(const LocalCloud& source, const LocalCloud& target, const IcpOptions& options)
    : source_(source),
      target_(target),
      options_(options),
      target_search_(make_search(options.search, target.points)),
      source_search_(source.points),
      target_surface_(target.points) {}

std::vector<Match> PairFinder::find(const Pose& pose, double max_distance_m) const {
  const bool planes = options_.method == IcpMethod::point_to_plane;
  const bool compare_normals = !source_.normals.empty() && !target_.normals.empty();
  const double least_cosine = std::cos(options_.max_normal_angle_rad);
  std::vector<Match> matches(source_.points.size());
  const auto match_all = [&](const auto& search) {
    const auto match_one = [&](std::size_t i) {
      const Eigen::Vector3d moved = pose * source_.points[i];
      const std::optional<Neighbour> found = search.nearest(moved, max_distance_m);
      if (!found) return;
      const double distance_m = std::sqrt(found->distance2_m2);
      const Eigen::Vector3d normal =
          target_.normals.empty() ? Eigen::Vector3d::Zero().eval() : target_.normals[found->index];
      if (planes && normal.isZero()) return;
      if (compare_normals && !normal.isZero() && !source_.normals[i].isZero() &&
          (pose.linear() * source_.normals[i]).dot(normal) < least_cosine)
        return;
      const PointPair pair{moved, target_.points[found->index], normal};
      const double residual_m = planes ? std::abs(PointToPlane::value(pair)) : distance_m;
      matches[i] = {found->index, distance_m, residual_m};
    };
    parallel_for(source_.points.size(), match_one, chunk);
  };
  std::visit(match_all, target_search_);
  return matches;
}

double PairFinder::mutual_median_m(const Pose& pose, const std::vector<Match>& matches) const {
  const std::size_t stride = std::max<std::size_t>(1, matches.size() / 2048);
  const Pose source_from_target = pose.inverse();
  std::vector<double> distances((matches.size() + stride - 1) / stride, -1);
  parallel_for(distances.size(), [&](std::size_t i) {
    const Match& match = matches[i * stride];
    if (match.target == no_partner) return;
    const auto back = source_search_.nearest(source_from_target * target_.points[match.target]);
    // Not by index: repeated points are each other's equal; and rounding may part equal distances.
    if (std::sqrt(back->distance2_m2) >= match.distance_m * (1 - 1e-9)) distances[i] = match.distance_m;
  });
  std::erase(distances, -1);
  return quantile(distances, 0.5);
}

Gates PairFinder::tightened(const Gates& previous, const Pose& pose,
                            const std::vector<Match>& matches) const {
  Gates gates;
  gates.distance_m = options_.max_pair_distance_m;
  if (!(gates.distance_m > 0)) {
    const double least = std::max(target_surface_.spacing_m(), 1e-12 * target_.radius_m);
    gates.distance_m = gate_in_medians * std::max(mutual_median_m(pose, matches), least);
  }
  gates.distance_m = std::min(gates.distance_m, previous.distance_m);
  std::vector<double> residuals;
  for (const Match& match : matches)
    if (match.target != no_partner && match.distance_m <= gates.distance_m)
      residuals.push_back(match.residual_m);
  gates.residual_m = std::min(previous.residual_m, quantile(residuals, 1 - options_.trim_fraction));
  return gates;
}

std::vector<std::uint32_t> PairFinder::kept(const std::vector<Match>& matches,
                                            const Gates& gates) const {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < matches.size(); ++i)
    if (matches[i].target != no_partner && matches[i].distance_m <= gates.distance_m &&
        matches[i].residual_m <= gates.residual_m)
      indices.push_back(i);
  return indices;
}

double PairFinder::cost_m2(const std::vector<Match>& matches, const Gates& gates) const {
  const double beyond_m2 = gates.residual_m * gates.residual_m;
  double sum = 0;
  for (const Match& match : matches) {
    const bool paired = match.target != no_partner && match.distance_m <= gates.distance_m;
    sum += paired ? std::min(match.residual_m * match.residual_m, beyond_m2) : beyond_m2;
  }
  return sum / static_cast<double>(matches.size());
}

PointPair PairFinder::pair(const Pose& pose, const std::vector<Match>& matches,
                           std::uint32_t i) const {
  const std::uint32_t j = matches[i].target;
  return {pose * source_.points[i], target_.points[j],
          target_.normals.empty() ? Eigen::Vector3d::Zero().eval() : target_.normals[j]};
}

}  // namespace scan
