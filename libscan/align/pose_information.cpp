// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "libscan/align/pose_step.h"
#include "libscan/align/shared_noise.h"

namespace scan {
namespace {

Vector6 row_of(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal) {
  Vector6 row;
  row << arm.cross(normal), normal;
  return row;
}

}  // namespace

Pull pull_of(const PairFinder& finder, const Pose& pose, const Couple& couple,
             const WelschLoss& loss, const DataFrame& frame) {
  const PointPair pair = finder.pair(pose, couple);
  const double weight = loss.weight(couple.residual_m);
  const double curvature = loss.curvature(couple.residual_m);
  const Eigen::Vector3d apart = (pair.moved - pair.target) / frame.size_m;
  const Eigen::Vector3d arm = (pair.moved - frame.centre) / frame.size_m - 0.5 * apart;
  const Vector6 there = row_of(arm, pair.normal), here = row_of(arm, pair.moved_normal);
  Eigen::Matrix<double, 3, 6> marks;
  marks << -cross_matrix(arm), Eigen::Matrix3d::Identity();
  // Of a residual of three coordinates the loss bends along one and is straight along two.
  const double mean_curvature = (curvature + 2 * weight) / 3;
  Pull pull;
  if (!pair.normal.isZero(0))
    pull.curvature = 0.5 * (there * here.transpose() + here * there.transpose());
  else
    pull.curvature = marks.transpose() * marks;
  switch (finder.method()) {
    case IcpMethod::point_to_point:
      pull.gradient = weight * marks.transpose() * apart;
      pull.curvature *= mean_curvature;
      break;
    case IcpMethod::point_to_plane:
      pull.gradient = weight * there * pair.normal.dot(apart);
      pull.curvature *= curvature;
      break;
    case IcpMethod::symmetric:
      pull.gradient = 0.25 * weight * (there + here) * (pair.normal + pair.moved_normal).dot(apart);
      pull.curvature *= curvature;
      break;
    case IcpMethod::plane_to_plane: {
      const Eigen::Matrix3d metric = finder.metric(pose, couple);
      pull.gradient = weight * marks.transpose() * (metric * apart);
      pull.curvature = curvature * marks.transpose() * metric * marks;
      break;
    }
  }
  return pull;
}

namespace {

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
  std::vector<Vector6> pulls;
  std::vector<Eigen::Vector3d> at;
  Matrix6 curvature = Matrix6::Zero(), scatter = Matrix6::Zero();
  for (const Couple& couple : couples) {
    const Pull pull = pull_of(finder, pose, couple, loss, frame);
    pulls.push_back(pull.gradient);
    at.push_back(finder.target().points[couple.target]);
    curvature += pull.curvature;
    scatter += pull.gradient * pull.gradient.transpose();
  }
  // Residuals cannot be known better than the coordinates are rounded.
  const double rounding =
      1e-15 * (finder.target().origin.norm() + finder.target().radius_m) / frame.size_m;
  scatter += std::max(rounding * rounding, 1e-300) * curvature.trace() * Matrix6::Identity();
  curvature *= finder.shown_share(pose, couples, loss);
  const TwistBasis rest = rest_of(weak);
  const Eigen::MatrixXd b = rest.transpose() * curvature * rest;
  const Eigen::LLT<Eigen::MatrixXd> held(b), spread(rest.transpose() * scatter * rest);
  if (held.info() != Eigen::Success) return Matrix6::Zero();
  for (Vector6& pull : pulls) {
    const Eigen::VectorXd white = spread.matrixL().solve(rest.transpose() * pull);
    pull.setZero();
    pull.head(rest.cols()) = white;
  }
  const double sharing = noise_sharing(pulls, at, static_cast<int>(rest.cols()));
  Matrix6 information = rest * (b * spread.solve(b)) * rest.transpose() / sharing;
  information.rightCols<3>() /= frame.size_m;
  information.bottomRows<3>() /= frame.size_m;
  return 0.5 * (information + information.transpose());
}

}  // namespace scan
