// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_motion.h"

#include <Eigen/SparseCholesky>

#include "libscan/align/joint_system.h"

namespace scan {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// A tenth of the step at which iterations end (IcpOptions).
constexpr double negligible = 1e-7;
// Each is off by the last one's error times the turn.
constexpr int most_corrections = 5;
constexpr double damping = 1e-14;  // of the mean diagonal: scans that no chain ties stay

Pose moved(const Pose& pose, const Vector6& twist, double size_m) {
  Vector6 turn = Vector6::Zero();
  turn.head<3>() = twist.head<3>();
  return make_pose(nearest_rotation(exp(turn).linear() * pose.linear()),
                   pose.translation() + size_m * twist.tail<3>());
}

}  // namespace

Vector6 relative_twist(const JointForm& form, std::span<const Pose> before,
                       std::span<const Pose> after) {
  const Pose there = before[form.target] * after[form.target].inverse() * after[form.source];
  const Eigen::Translation3d centre(form.frame.centre);
  Vector6 twist = log(centre.inverse() * there * before[form.source].inverse() * centre);
  twist.tail<3>() /= form.frame.size_m;
  return twist;
}

Sparse relative_twists(std::span<const JointForm> forms, const JointFrame& frame) {
  JointEntries entries;
  for (std::size_t k = 0; k < forms.size(); ++k)
    for (const std::size_t scan : {forms[k].source, forms[k].target}) {
      if (!frame.free[scan]) continue;
      const double sign = scan == forms[k].source ? 1 : -1;
      const Matrix6 carry = sign * twist_to_form(frame, scan, forms[k]);
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
          entries.push_back(
              {static_cast<int>(6 * k) + i, static_cast<int>(6 * scan) + j, carry(i, j)});
    }
  Sparse relative(6 * Eigen::Index(forms.size()), 6 * Eigen::Index(frame.centres.size()));
  relative.setFromTriplets(entries.begin(), entries.end());
  return relative;
}

std::vector<Pose> moved_together(std::span<const JointForm> forms, const JointFrame& frame,
                                 std::span<const Pose> world_from_local,
                                 std::span<const Vector6> twists) {
  std::vector<Pose> poses(world_from_local.begin(), world_from_local.end());
  Eigen::VectorXd x(6 * Eigen::Index(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i) x.segment<6>(6 * Eigen::Index(i)) = twists[i];
  const Sparse relative = relative_twists(forms, frame);
  const Eigen::VectorXd wanted = relative * x;
  Eigen::SimplicialLDLT<Sparse> factor;
  for (int round = 0;; ++round) {
    for (std::size_t i = 0; i < poses.size(); ++i)
      if (const Vector6 own = x.segment<6>(6 * Eigen::Index(i)); !own.isZero(0))
        poses[i] = moved(poses[i], own, frame.size_m);
    Eigen::VectorXd missing = wanted;
    for (std::size_t k = 0; k < forms.size(); ++k)
      missing.segment<6>(6 * Eigen::Index(k)) -= relative_twist(forms[k], world_from_local, poses);
    if (round == most_corrections || !(missing.cwiseAbs().maxCoeff() > negligible)) return poses;
    if (round == 0) {
      Sparse normal = relative.transpose() * relative;
      const double least = damping * std::max(normal.diagonal().mean(), 1e-300);
      for (Eigen::Index i = 0; i < normal.rows(); ++i) normal.coeffRef(i, i) += least;
      factor.compute(normal);
    }
    x = factor.solve(relative.transpose() * missing);
  }
}

}  // namespace scan
