// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/pose_judge.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "libscan/align/residual.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr std::size_t settle_points = 600, judge_points = 1500;
constexpr int settle_rounds = 12;
constexpr double least_pairs = 6;
constexpr double least_cosine = 0.7;  // between normals of one surface
constexpr double meet_reach_in_sides = 1.5, meet_plane_in_sides = 0.35;
constexpr double clear_in_sides = 2;  // in front of a surface, beyond doubt
constexpr double doubt = 20;          // contradicting points that count as seen from the start

std::size_t stride_for(std::size_t size, std::size_t wanted) {
  return std::max<std::size_t>(1, (size + wanted - 1) / wanted);
}

std::vector<Eigen::Vector3d> directions_from(const Eigen::Vector3d& eye,
                                             const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector3d> directions;
  for (const Eigen::Vector3d& x : points) directions.push_back((x - eye).normalized());
  return directions;
}

}  // namespace

struct PoseJudge::Side {
  explicit Side(const ScanFeatures& scan)
      : features(scan), cloud(scan.cloud), search(cloud.points) {
    for (const Eigen::Vector3d& x : cloud.points) centre += x / static_cast<double>(cloud.size());
    if (features.viewpoint)
      views = std::make_unique<KdTree>(directions_from(*features.viewpoint, cloud.points));
  }

  // In front of what this scan saw in that direction: its ray went through there.
  bool saw_through(const Eigen::Vector3d& x) const {
    if (!views) return false;
    const Eigen::Vector3d ray = x - *features.viewpoint;
    const double range_m = ray.norm(), side_m = features.side_m;
    if (!(range_m > 0)) return false;
    const auto seen = views->nearest(ray / range_m, side_m / range_m);
    if (!seen) return false;
    const Eigen::Vector3d& surface = cloud.points[seen->index];
    const double clear_m = clear_in_sides * side_m;
    return (surface - *features.viewpoint).norm() - range_m > clear_m &&
           cloud.normals[seen->index].dot(x - surface) > clear_m;
  }

  const ScanFeatures& features;
  const PointCloud& cloud;
  KdTree search;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  std::unique_ptr<KdTree> views;
};

namespace {

struct Tally {
  double used = 0, met = 0, conflicts = 0, squares_m2 = 0;
};

// The points of `a` before the surface of `b`.
template <class Side>
Tally tally(const Side& a, const Side& b, const Pose& b_from_a) {
  Tally sum;
  const double side_m = a.features.side_m;
  const std::size_t stride = stride_for(a.cloud.size(), judge_points);
  for (std::size_t i = 0; i < a.cloud.size(); i += stride) {
    ++sum.used;
    const Eigen::Vector3d x = b_from_a * a.cloud.points[i];
    const Eigen::Vector3d n = b_from_a.linear() * a.cloud.normals[i];
    const auto near = b.search.nearest(x, meet_reach_in_sides * side_m);
    if (!near) {
      sum.conflicts += b.saw_through(x);
      continue;
    }
    const Eigen::Vector3d& m = b.cloud.normals[near->index];
    const double off_m = m.dot(x - b.cloud.points[near->index]);
    const double cosine = n.dot(m);
    if (cosine > least_cosine && std::abs(off_m) < meet_plane_in_sides * side_m) {
      ++sum.met;
      sum.squares_m2 += off_m * off_m;
    } else if (cosine < least_cosine || std::abs(off_m) >= 2 * meet_plane_in_sides * side_m) {
      ++sum.conflicts;
    }
  }
  return sum;
}

Pose moved_about(const Eigen::Vector3d& centre, const Vector6& twist, const Pose& pose) {
  return Eigen::Translation3d(centre) * exp(twist) * Eigen::Translation3d(-centre) * pose;
}

}  // namespace

PoseJudge::PoseJudge(const ScanFeatures& source, const ScanFeatures& target)
    : source_(std::make_unique<Side>(source)), target_(std::make_unique<Side>(target)) {}
PoseJudge::~PoseJudge() = default;

// Sums over point-to-plane pairs within reach whose normals agree, about `centre`; the metric is
// the sum of the squared motions of the points themselves.
struct PoseJudge::Pairs {
  Matrix6 information = Matrix6::Zero(), metric = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  double count = 0;
};

PoseJudge::Pairs PoseJudge::pairs(const Pose& pose, double reach_m,
                                  const Eigen::Vector3d& centre) const {
  Pairs sum;
  const PointCloud& from = source_->cloud;
  const std::size_t stride = stride_for(from.size(), settle_points);
  for (std::size_t i = 0; i < from.size(); i += stride) {
    const Eigen::Vector3d x = pose * from.points[i];
    const auto near = target_->search.nearest(x, reach_m);
    if (!near) continue;
    const Eigen::Vector3d& m = target_->cloud.normals[near->index];
    if ((pose.linear() * from.normals[i]).dot(m) < least_cosine) continue;
    const PointPair pair{x, target_->cloud.points[near->index], m};
    const auto jacobian = PointToPlane::jacobian(pair, centre);
    const auto motion = PointToPoint::jacobian(pair, centre);
    sum.information += jacobian.transpose() * jacobian;
    sum.metric += motion.transpose() * motion;
    sum.gradient += jacobian.transpose() * PointToPlane::value(pair);
    ++sum.count;
  }
  // A point stands for a cube, which has an inertia of its own: no set of points is singular.
  sum.metric.diagonal().head<3>().array() +=
      sum.count * source_->features.side_m * source_->features.side_m / 6;
  return sum;
}

Pose PoseJudge::settled(const Pose& target_from_source) const {
  Pose pose = target_from_source;
  const double side_m = source_->features.side_m;
  for (int round = 0; round < settle_rounds; ++round) {
    const double reach_m = side_m * std::max(1.0, 3.0 - 0.25 * round);
    const Eigen::Vector3d centre = pose * source_->centre;
    const Pairs sum = pairs(pose, reach_m, centre);
    if (sum.count < least_pairs) return pose;
    // Motions are damped by how far they carry the points: by a millionth of what a plane resists.
    const Vector6 twist = (sum.information + 1e-6 * sum.metric).ldlt().solve(-sum.gradient);
    const Pose moved = moved_about(centre, twist, pose);
    pose = make_pose(nearest_rotation(moved.linear()), moved.translation());
  }
  return pose;
}

std::vector<Pose> PoseJudge::slid(const Pose& target_from_source, double distance_m) const {
  const Eigen::Vector3d centre = target_from_source * source_->centre;
  const Pairs sum = pairs(target_from_source, source_->features.side_m, centre);
  if (sum.count < least_pairs) return {};
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> solver(sum.information, sum.metric);
  std::vector<Pose> poses;
  for (int k = 0; k < 3; ++k)
    for (const double sign : {1.0, -1.0}) {
      // Eigenvectors have v^T metric v = 1: the points move by 1 / sqrt(count).
      const Vector6 twist = sign * distance_m * std::sqrt(sum.count) * solver.eigenvectors().col(k);
      poses.push_back(moved_about(centre, twist, target_from_source));
    }
  return poses;
}

double PoseJudge::tolerance_m() const {
  return meet_plane_in_sides * source_->features.side_m;
}

double PoseJudge::least_resistance(const Pose& target_from_source) const {
  const Eigen::Vector3d centre = target_from_source * source_->centre;
  const Pairs sum = pairs(target_from_source, source_->features.side_m, centre);
  if (sum.count < least_pairs) return 0;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> solver(sum.information, sum.metric,
                                                                 Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

PoseVerdict PoseJudge::judge(const Pose& target_from_source) const {
  const Tally forth = tally(*source_, *target_, target_from_source);
  const Tally back = tally(*target_, *source_, target_from_source.inverse());
  PoseVerdict verdict;
  if (forth.used == 0 || back.used == 0) return verdict;
  verdict.overlap = source_->cloud.size() <= target_->cloud.size() ? forth.met / forth.used
                                                                   : back.met / back.used;
  const double met = forth.met + back.met;
  if (met == 0) return verdict;
  const double conflicts = forth.conflicts + back.conflicts;
  const double variance_m2 = (forth.squares_m2 + back.squares_m2) / met;
  verdict.conflict = conflicts / (met + conflicts);
  verdict.rms_m = std::sqrt(variance_m2);
  const double close = std::max(0.0, 1 - 3 * variance_m2 / (tolerance_m() * tolerance_m()));
  verdict.trust = close * met / (met + conflicts + doubt);
  return verdict;
}

}  // namespace scan
