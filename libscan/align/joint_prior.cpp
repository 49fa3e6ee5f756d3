// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_prior.h"

#include <Eigen/Cholesky>

#include "libscan/align/joint_refinement.h"

namespace scan {

Vector6 twist_to(const Pose& guess, const Pose& pose, double size_m) {
  const Pose turn = make_pose(guess.linear() * pose.linear().transpose(), Eigen::Vector3d::Zero());
  Vector6 twist = log(turn);
  twist.tail<3>() = (guess.translation() - pose.translation()) / size_m;
  return twist;
}

Matrix6 covariance_of(const GuessSigma& sigma, const Eigen::Vector3d& arm_m, double size_m) {
  Vector6 variances;
  variances << Eigen::Vector3d::Constant(sigma.rotation_rad * sigma.rotation_rad / 3),
      Eigen::Vector3d::Constant(sigma.translation_m * sigma.translation_m / 3);
  Matrix6 carry = Matrix6::Identity();
  carry.bottomLeftCorner<3, 3>() = -cross_matrix(arm_m);
  carry.bottomRows<3>() /= size_m;
  return carry * variances.asDiagonal() * carry.transpose();
}

GuessPrior guess_prior(const JointFrame& frame, std::span<const Pose> world_from_local,
                       std::span<const Pose> guesses, std::span<const Eigen::Vector3d> scanners,
                       std::span<const GuessSigma> sigmas, std::size_t anchor) {
  GuessPrior prior;
  if (sigmas.empty()) return prior;
  prior.information.assign(guesses.size(), Matrix6::Zero());
  prior.twists.assign(guesses.size(), Vector6::Zero());
  for (std::size_t i = 0; i < guesses.size(); ++i) {
    if (!frame.free[i]) continue;
    const Eigen::Vector3d& centre = frame.centres[i];
    const Matrix6 covariance =
        covariance_of(sigmas[i], centre - scanners[i], frame.size_m) +
        covariance_of(sigmas[anchor], centre - scanners[anchor], frame.size_m);
    prior.information[i] = covariance.ldlt().solve(Matrix6::Identity());
    prior.information[i] = (0.5 * (prior.information[i] + prior.information[i].transpose())).eval();
    prior.twists[i] = twist_to(guesses[i], world_from_local[i], frame.size_m);
  }
  return prior;
}

}  // namespace scan
