// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "libscan/align/pose_step.h"
#include "libscan/align/shared_noise.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t chunk = 256;

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

// What the pairs pull with, where, and what they hold together.
struct Pulls {
  std::vector<Vector6> gradients;
  std::vector<Eigen::Vector3d> at;
  Matrix6 curvature = Matrix6::Zero(), scatter = Matrix6::Zero();
};

Pulls pulls_of(const PairFinder& finder, const Pose& pose, std::span<const Couple> couples,
               const WelschLoss& loss, const DataFrame& frame) {
  struct Sum {
    Matrix6 curvature = Matrix6::Zero(), scatter = Matrix6::Zero();
    Sum& operator+=(const Sum& other) {
      curvature += other.curvature, scatter += other.scatter;
      return *this;
    }
  };
  Pulls pulls;
  pulls.gradients.resize(couples.size());
  pulls.at.resize(couples.size());
  const Sum sum =
      ordered_sum(couples.size(), chunk, Sum{}, [&](std::size_t begin, std::size_t end) {
        Sum part;
        for (std::size_t i = begin; i < end; ++i) {
          const Pull pull = pull_of(finder, pose, couples[i], loss, frame);
          pulls.gradients[i] = pull.gradient;
          pulls.at[i] = finder.target().points[couples[i].target];
          part.curvature += pull.curvature;
          part.scatter.noalias() += pull.gradient * pull.gradient.transpose();
        }
        return part;
      });
  pulls.curvature = sum.curvature;
  pulls.scatter = sum.scatter;
  return pulls;
}

}  // namespace

Matrix6 pose_information(const PairFinder& finder, const Pose& pose,
                         std::span<const Couple> couples, const WelschLoss& loss,
                         const DataFrame& frame, const TwistBasis& weak) {
  if (weak.cols() == 6) return Matrix6::Zero();
  Pulls pulls = pulls_of(finder, pose, couples, loss, frame);
  // Residuals cannot be known better than the coordinates are rounded.
  const double rounding =
      1e-15 * (finder.target().origin.norm() + finder.target().radius_m) / frame.size_m;
  pulls.scatter +=
      std::max(rounding * rounding, 1e-300) * pulls.curvature.trace() * Matrix6::Identity();
  pulls.curvature *= finder.shown_share(pose, couples, loss);
  const TwistBasis rest = rest_of(weak);
  const Eigen::MatrixXd b = rest.transpose() * pulls.curvature * rest;
  const Eigen::LLT<Eigen::MatrixXd> held(b), spread(rest.transpose() * pulls.scatter * rest);
  if (held.info() != Eigen::Success) return Matrix6::Zero();
  Matrix6 whitening = Matrix6::Zero();
  whitening.topRows(rest.cols()) = spread.matrixL().solve(Eigen::MatrixXd(rest.transpose()));
  for (Vector6& gradient : pulls.gradients) gradient = (whitening * gradient).eval();
  const double sharing = noise_sharing(pulls.gradients, pulls.at, static_cast<int>(rest.cols()));
  Matrix6 information = rest * (b * spread.solve(b)) * rest.transpose() / sharing;
  information.rightCols<3>() /= frame.size_m;
  information.bottomRows<3>() /= frame.size_m;
  return 0.5 * (information + information.transpose());
}

}  // namespace scan
