// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_guesses.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>

#include "libscan/align/joint_motion.h"
#include "libscan/align/joint_system.h"

namespace scan {
namespace {

// Of the diagonal; a motion that changes no couple stays.
constexpr double damping = 1e-9;

using Sparse = Eigen::SparseMatrix<double>;

// The least x^T M x / 2 - m^T x is the nearest to the guesses.
struct Nearness {
  Sparse matrix;
  Eigen::VectorXd right_side;
};

Nearness nearness_of_couples(std::span<const JointForm> forms, const Sparse& relative,
                             std::span<const Pose> world_from_local,
                             std::span<const Pose> guesses) {
  Eigen::VectorXd wanted(relative.rows());
  for (std::size_t k = 0; k < forms.size(); ++k)
    wanted.segment<6>(6 * Eigen::Index(k)) = relative_twist(forms[k], world_from_local, guesses);
  return {relative.transpose() * relative, relative.transpose() * wanted};
}

Nearness nearness_by(const GuessPrior& prior) {
  JointEntries entries;
  Eigen::VectorXd pull(6 * Eigen::Index(prior.information.size()));
  for (std::size_t i = 0; i < prior.information.size(); ++i) {
    const Eigen::Index row = 6 * Eigen::Index(i);
    for (int k = 0; k < 6; ++k)
      for (int l = 0; l < 6; ++l)
        entries.push_back({int(row) + k, int(row) + l, prior.information[i](k, l)});
    pull.segment<6>(row) = prior.information[i] * prior.twists[i];
  }
  Sparse matrix(pull.rows(), pull.rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return {matrix, pull};
}

}  // namespace

WayToGuesses way_to_guesses(std::span<const JointForm> forms, const JointFrame& frame,
                            const JointBasis& weak, std::span<const Pose> world_from_local,
                            std::span<const Pose> guesses, double most_m, const GuessPrior& prior) {
  WayToGuesses way{.twists = std::vector<Vector6>(frame.centres.size(), Vector6::Zero())};
  if (weak.cols() == 0) return way;
  const Sparse motions = weak.sparseView();
  const Sparse relative = relative_twists(forms, frame);
  const Nearness near = prior.known()
                            ? nearness_by(prior)
                            : nearness_of_couples(forms, relative, world_from_local, guesses);
  Sparse normal = motions.transpose() * near.matrix * motions;
  const double least = std::max(damping * normal.diagonal().maxCoeff(), 1e-300);
  for (Eigen::Index i = 0; i < normal.rows(); ++i) normal.coeffRef(i, i) += least;
  const Eigen::SimplicialLDLT<Sparse> factor(normal);
  Eigen::VectorXd along = factor.solve(motions.transpose() * near.right_side);
  const Eigen::VectorXd moved = relative * (motions * along);
  double share = 1;
  for (std::size_t k = 0; k < forms.size(); ++k) {
    const double length_m = moved.segment<6>(6 * Eigen::Index(k)).norm() * forms[k].frame.size_m;
    if (length_m > most_m) share = std::min(share, most_m / length_m);
  }
  way.whole = share == 1;
  const Eigen::VectorXd all = share * (motions * along);
  for (std::size_t i = 0; i < way.twists.size(); ++i)
    way.twists[i] = all.segment<6>(6 * Eigen::Index(i));
  return way;
}

}  // namespace scan
