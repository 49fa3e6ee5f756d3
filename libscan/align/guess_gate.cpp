// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/guess_gate.h"

#include <Eigen/Cholesky>

#include "libscan/align/joint_prior.h"
#include "libscan/align/pose_edge.h"

namespace scan {
namespace {

// A guess's angle and length are normal along directions by chance (GuessSigma), of which a third
// of the square is stated for each axis: in sigmas 3 times a chi-square of two, here at its 99.9 %
// quantile. Errors whose components are independent stay below as often and more.
constexpr double limit = 3 * 13.816;

}  // namespace

bool is_ruled_out(const PreparedScans& scans, const PoseEdge& edge, const KnownGuesses& guesses) {
  if (guesses.sigmas.empty()) return false;
  const Pose& source = guesses.world_from_local[edge.source];
  const Pose& target = guesses.world_from_local[edge.target];
  const Pose by_pair = target * edge.target_from_source;
  const Eigen::Vector3d centre = source.translation();
  const Vector6 twist = twist_to(by_pair, source, 1);
  Matrix6 covariance = Matrix6::Zero();
  for (const std::size_t scan : {edge.source, edge.target}) {
    const Eigen::Vector3d scanner =
        guesses.world_from_local[scan] * Eigen::Vector3d(-scans.clouds[scan].origin);
    covariance += covariance_of(guesses.sigmas[scan], centre - scanner, 1);
  }
  // From turns and shifts of the source's middle in the world to those of the pair's information,
  // about the target's and in its frame.
  const Eigen::Matrix3d into_target = target.linear().transpose();
  Matrix6 carry = Matrix6::Zero();
  carry.topLeftCorner<3, 3>() = carry.bottomRightCorner<3, 3>() = into_target;
  carry.bottomLeftCorner<3, 3>() =
      cross_matrix(edge.target_from_source.translation()) * into_target;
  // With I = S^T S it is (S e)^T (1 + S E S^T)^-1 (S e), which holds for a singular I, too.
  const Matrix6 root = root_of(edge.information) * carry;
  const Vector6 off = root * twist;
  const Matrix6 spread = Matrix6::Identity() + root * covariance * root.transpose();
  return off.dot(spread.ldlt().solve(off)) > limit;
}

}  // namespace scan
