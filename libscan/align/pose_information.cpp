// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "libscan/align/pose_step.h"

namespace scan {
namespace {

// Patches of the target's surface, enough for a scatter in six dimensions. What noise that
// neighbours share carries across their borders falls with their width: it is found from a quarter
// of them, twice as wide.
constexpr std::size_t patches = 32;

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

// The scatter of the pulls' sums over patches of equal counts along a curve over the target. The
// pose has followed each patch by the share of the curvature that is its own: what it leaves of the
// patch's sum is smaller by (1 - share), which is put right (Bell and McCaffrey 2002, CR2, to first
// order in what patches differ).
Matrix6 scatter_over(std::span<const Pull> pulls, std::size_t count, const Matrix6& inverse) {
  Matrix6 scatter = Matrix6::Zero();
  for (std::size_t c = 0; c < count; ++c) {
    Pull sum;
    const std::size_t begin = c * pulls.size() / count, end = (c + 1) * pulls.size() / count;
    for (const Pull& pull : pulls.subspan(begin, end - begin)) {
      sum.gradient += pull.gradient;
      sum.curvature += pull.curvature;
    }
    const Matrix6 left = Matrix6::Identity() - sum.curvature * inverse;
    const Vector6 whole = left.partialPivLu().solve(sum.gradient);
    scatter += 0.5 * (whole * sum.gradient.transpose() + sum.gradient * whole.transpose());
  }
  return scatter;
}

}  // namespace

Matrix6 pose_information(const PairFinder& finder, const Pose& pose,
                         std::span<const Couple> couples, const WelschLoss& loss,
                         const DataFrame& frame, const TwistBasis& weak) {
  if (weak.cols() == 6) return Matrix6::Zero();
  std::vector<Couple> ordered(couples.begin(), couples.end());
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const Couple& a, const Couple& b) { return a.target < b.target; });
  std::vector<Pull> pulls;
  pulls.reserve(ordered.size());
  Matrix6 curvature = Matrix6::Zero();
  for (const Couple& couple : ordered) {
    pulls.push_back(pull_of(finder, pose, couple, loss, frame));
    curvature += pulls.back().curvature;
  }
  const TwistBasis rest = rest_of(weak);
  const Eigen::MatrixXd b = rest.transpose() * curvature * rest;
  const Eigen::LLT<Eigen::MatrixXd> factor(b);
  if (factor.info() != Eigen::Success) return Matrix6::Zero();  // nothing is held
  const Matrix6 inverse = rest * factor.solve(Eigen::MatrixXd(rest.transpose()));
  Matrix6 scatter = scatter_over(pulls, patches, inverse);
  const double narrow = (inverse * scatter).trace();
  const double wide = (inverse * scatter_over(pulls, patches / 4, inverse)).trace();
  if (narrow > 0) scatter *= std::max(1.0, 2 * wide / narrow - 1);
  // Residuals cannot be known better than the coordinates are rounded.
  const double rounding =
      1e-15 * (finder.target().origin.norm() + finder.target().radius_m) / frame.size_m;
  scatter += std::max(rounding * rounding, 1e-300) * curvature.trace() * Matrix6::Identity();
  // The inverse of a scatter from n sums in d dimensions is too large by n / (n - d - 1).
  const double share = 1 - (static_cast<double>(rest.cols()) + 1) / patches;
  const Eigen::MatrixXd m = rest.transpose() * scatter * rest;
  Matrix6 information = share * rest * (b * m.ldlt().solve(b)) * rest.transpose();
  information.rightCols<3>() /= frame.size_m;
  information.bottomRows<3>() /= frame.size_m;
  return 0.5 * (information + information.transpose());
}

}  // namespace scan
