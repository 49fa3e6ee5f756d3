// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "libscan/align/pose_step.h"

namespace scan {
namespace {

// Patches of the target's surface: enough for a scatter in six dimensions, and large against what
// the noise of neighbours shares.
constexpr std::size_t patches = 128;

Vector6 row_of(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal) {
  Vector6 row;
  row << arm.cross(normal), normal;
  return row;
}

// What a pair pulls the pose with, and how strongly it holds it.
struct Pull {
  Vector6 gradient = Vector6::Zero();
  Matrix6 curvature = Matrix6::Zero();
};

Pull pull_of(const PairFinder& finder, const Pose& pose, const Couple& couple,
             const WelschLoss& loss, const DataFrame& frame) {
  const PointPair pair = finder.pair(pose, couple);
  const double weight = loss.weight(couple.residual_m);
  const double curvature = loss.curvature(couple.residual_m);
  const Eigen::Vector3d arm = (pair.moved - frame.centre) / frame.size_m;
  const Eigen::Vector3d apart = (pair.moved - pair.target) / frame.size_m;
  const bool planes = !pair.normal.isZero(0);
  Pull pull;
  Eigen::Matrix<double, 3, 6> marks;
  marks << -cross_matrix(arm), Eigen::Matrix3d::Identity();
  if (planes) {
    const Vector6 there = row_of(arm, pair.normal), here = row_of(arm, pair.moved_normal);
    pull.curvature = 0.5 * curvature * (there * here.transpose() + here * there.transpose());
  } else {
    pull.curvature = weight * marks.transpose() * marks;
  }
  switch (finder.method()) {
    case IcpMethod::point_to_point:
      pull.gradient = weight * marks.transpose() * apart;
      break;
    case IcpMethod::point_to_plane:
      pull.gradient = weight * row_of(arm, pair.normal) * pair.normal.dot(apart);
      break;
    case IcpMethod::symmetric: {
      const Eigen::Vector3d mean = 0.5 * (pair.normal + pair.moved_normal);
      pull.gradient = weight * row_of(arm - 0.5 * apart, mean) * mean.dot(apart);
      break;
    }
    case IcpMethod::plane_to_plane:
      pull.gradient = weight * marks.transpose() * (finder.metric(pose, couple) * apart);
      break;
  }
  return pull;
}

// Orthonormal columns that span what `weak` leaves.
TwistBasis rest_of(const TwistBasis& weak) {
  if (weak.cols() == 0) return Matrix6::Identity();
  const Eigen::HouseholderQR<TwistBasis> qr(weak);
  const Matrix6 q = qr.householderQ();
  return q.rightCols(6 - weak.cols());
}

}  // namespace

Matrix6 pose_information(const PairFinder& finder, const Pose& pose,
                         std::span<const Couple> couples, const WelschLoss& loss,
                         const DataFrame& frame, const TwistBasis& weak) {
  if (weak.cols() == 6) return Matrix6::Zero();
  const std::size_t targets = finder.target().size();
  std::vector<Vector6> gradients(patches, Vector6::Zero());
  std::vector<bool> used(patches, false);
  Matrix6 curvature = Matrix6::Zero();
  for (const Couple& couple : couples) {
    const std::size_t patch = couple.target * patches / targets;
    const Pull pull = pull_of(finder, pose, couple, loss, frame);
    gradients[patch] += pull.gradient;
    curvature += pull.curvature;
    used[patch] = true;
  }
  Matrix6 scatter = Matrix6::Zero();
  for (const Vector6& gradient : gradients) scatter += gradient * gradient.transpose();
  // Residuals cannot be known better than the coordinates are rounded.
  const double rounding =
      1e-15 * (finder.target().origin.norm() + finder.target().radius_m) / frame.size_m;
  scatter += std::max(rounding * rounding, 1e-300) * curvature.trace() * Matrix6::Identity();
  const TwistBasis rest = rest_of(weak);
  const auto n = static_cast<double>(std::count(used.begin(), used.end(), true));
  // The inverse of a scatter from n sums in d dimensions is too large by n / (n - d - 1).
  const double share = std::max(1.0, n - double(rest.cols()) - 1) / n;
  const Eigen::MatrixXd b = rest.transpose() * curvature * rest;
  const Eigen::MatrixXd m = rest.transpose() * scatter * rest;
  Matrix6 information = share * rest * (b * m.ldlt().solve(b)) * rest.transpose();
  information.rightCols<3>() /= frame.size_m;
  information.bottomRows<3>() /= frame.size_m;
  return 0.5 * (information + information.transpose());
}

}  // namespace scan
