// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>

#include "libscan/align/joint_refinement.h"
#include "libscan/align/joint_solver.h"
#include "libscan/align/shared_noise.h"

namespace scan {
namespace {

constexpr double rounding_share = 1e-10;  // as in observability.cpp

// What each scan's noise shared among places adds to its scatter (shared_noise.h), along all that
// is not weak.
std::vector<double> noise_shares(const PlacePulls& places, std::size_t scans,
                                 const JointBasis& weak) {
  std::vector<std::vector<Vector6>> pulls(scans);
  std::vector<std::vector<Eigen::Vector3d>> at(scans);
  for (const auto& [place, all] : places)
    for (const auto& [scan, pull] : all) {
      pulls[scan].push_back(pull);
      at[scan].emplace_back(double(place[0]), double(place[1]), double(place[2]));
    }
  std::vector<double> shares(scans, 1);
  for (std::size_t i = 0; i < scans; ++i) {
    Matrix6 scatter = Matrix6::Zero();
    const Matrix6 rest = complement_projector(weak_motions_of(i, weak));
    for (Vector6& pull : pulls[i]) {
      pull = (rest * pull).eval();
      scatter += pull * pull.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scatter);
    Vector6 roots = Vector6::Zero();
    for (int k = 0; k < 6; ++k)
      if (const double variance = solver.eigenvalues()[k];
          variance > rounding_share * solver.eigenvalues()[5])
        roots[k] = 1 / std::sqrt(variance);
    const auto dimensions = static_cast<int>((roots.array() > 0).count());
    if (dimensions == 0) continue;
    const Matrix6 whitening = roots.asDiagonal() * solver.eigenvectors().transpose();
    for (Vector6& pull : pulls[i]) pull = (whitening * pull).eval();
    // Its own cut keeps chance from making all ties of a scan surer; one at 1 raises the mean of
    // what it leaves by 4 %.
    shares[i] = noise_sharing(pulls[i], at[i], dimensions);
  }
  return shares;
}

// The scatter of the pulls, those of a couple longer by the root of what its free scans' noise is
// shared among places: in the geometric mean, since a couple must pull both its scans alike. Else
// what it pulls the one with and the other would no longer cancel where they move together.
JointEntries shared_scatter(const JointSystem& system, std::span<const JointForm> forms,
                            std::span<const JointDetail> details, const JointBasis& weak) {
  std::vector<double> factors(forms.size(), 1);
  const std::vector<double> shares =
      noise_shares(system.pulls_by_place(details, factors), std::size_t(weak.rows() / 6), weak);
  for (std::size_t k = 0; k < forms.size(); ++k) {
    const auto& [source, target] = std::pair(forms[k].source, forms[k].target);
    const double both = system.has(source) && system.has(target) ? 0.5 : 1;
    factors[k] = std::sqrt(std::pow(shares[source] * shares[target], both));
  }
  return system.scatter(system.pulls_by_place(details, factors));
}

// Where the covariances of the scans and of their couples stand in the system: the scans first.
struct CovarianceBlocks {
  std::vector<std::pair<std::size_t, std::size_t>> scans;
  std::vector<BlockAt> places;
};

CovarianceBlocks covariance_blocks(const JointSystem& system, std::span<const JointForm> forms,
                                   std::size_t scans, const JointBasis& weak,
                                   const GuessPrior& prior) {
  std::set<std::pair<std::size_t, std::size_t>> couples;
  for (const JointForm& form : forms) couples.insert(std::minmax(form.source, form.target));
  std::vector<bool> known(scans);
  CovarianceBlocks blocks;
  const auto add = [&](std::size_t i, std::size_t j) {
    blocks.scans.emplace_back(i, j);
    blocks.places.emplace_back(system.row(i) / 6, system.row(j) / 6);
  };
  for (std::size_t i = 0; i < scans; ++i) {
    known[i] = system.has(i) && (prior.known() || weak_motions_of(i, weak).cols() == 0);
    if (known[i]) add(i, i);
  }
  for (const auto& [i, j] : couples)
    if (known[i] && known[j]) add(i, j);
  return blocks;
}

// W Q W^T (joint_prior.h), its blocks.
class GuessedPart {
 public:
  GuessedPart(const JointSystem& system, const JointBasis& weak, const GuessPrior& prior)
      : motions_(system.reduced(weak)) {
    if (!prior.known() || motions_.cols() == 0) return;
    const JointMatrix along = motions_.sparseView();
    const JointMatrix information = matrix_of(system, system.information(prior));
    spread_ = JointFactor(along.transpose() * information * along).solve(motions_.transpose());
  }
  Matrix6 block(const BlockAt& at) const {
    if (spread_.size() == 0) return Matrix6::Zero();
    return motions_.middleRows<6>(6 * Eigen::Index(at.first)) *
           spread_.middleCols<6>(6 * Eigen::Index(at.second));
  }

 private:
  Eigen::MatrixXd motions_, spread_;  // W, and Q W^T if both are there
};

}  // namespace

JointCovariances joint_covariances(std::span<const JointForm> forms,
                                   std::span<const JointDetail> details, const JointFrame& frame,
                                   const JointBasis& weak, const GuessPrior& prior) {
  JointCovariances result;
  result.of_scan.resize(frame.centres.size());
  result.from_guess.resize(frame.centres.size());
  for (std::size_t i = 0; i < result.of_scan.size(); ++i)
    if (!frame.free[i]) result.of_scan[i] = Matrix6::Zero();
  const JointSystem system(forms, frame);
  if (system.rows() == 0) return result;
  const JointMatrix guessed = matrix_of(system, system.information(prior));
  const WithholdingSolver solver(matrix_of(system, system.sum_of(details)) + guessed,
                                 withheld(system, weak, prior));
  const JointMatrix scatter =
      matrix_of(system, shared_scatter(system, forms, details, weak)) + guessed;
  const CovarianceBlocks wanted =
      covariance_blocks(system, forms, frame.centres.size(), weak, prior);
  std::vector<Matrix6> blocks = solver.sandwich_blocks(scatter, wanted.places);
  const GuessedPart along_weak(system, weak, prior);
  Matrix6 units = Matrix6::Identity();
  units.bottomRightCorner<3, 3>() *= frame.size_m;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const auto& [i, j] = wanted.scans[k];
    const Matrix6 from_guess = along_weak.block(wanted.places[k]);
    blocks[k] += from_guess;
    if (i == j) result.of_scan[i] = units * (0.5 * (blocks[k] + blocks[k].transpose())) * units;
    if (i == j && weak_motions_of(i, weak).cols() > 0)
      result.from_guess[i] = units * (0.5 * (from_guess + from_guess.transpose())) * units;
    if (i != j) result.between.push_back({i, j, units * blocks[k] * units});
  }
  return result;
}

}  // namespace scan
