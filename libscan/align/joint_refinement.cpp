// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_refinement.h"

#include <ceres/ceres.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "libscan/core/error.h"

namespace scan {
namespace {

// |S (x_source - x_target) - c|^2 with S^T S = A and S^T c = b, which is the form up to a constant.
class FormCost : public ceres::SizedCostFunction<6, 6, 6> {
 public:
  explicit FormCost(const ScanPairForm& form) {
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(form.a);
    const double least = 1e-12 * std::max(solver.eigenvalues()[5], 1e-300);
    for (int i = 0; i < 6; ++i) {
      if (!(solver.eigenvalues()[i] > least)) continue;  // fixes nothing along this motion
      const double root = std::sqrt(solver.eigenvalues()[i]);
      root_.row(i) = root * solver.eigenvectors().col(i).transpose();
      right_[i] = solver.eigenvectors().col(i).dot(form.b) / root;
    }
  }

  bool Evaluate(double const* const* x, double* residual, double** jacobian) const override {
    using Map = Eigen::Map<const Vector6>;
    using RowMajor = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
    Eigen::Map<Vector6> out(residual);
    out = root_ * (Map(x[0]) - Map(x[1])) - right_;
    if (jacobian && jacobian[0]) Eigen::Map<RowMajor> { jacobian[0] } = root_;
    if (jacobian && jacobian[1]) Eigen::Map<RowMajor> { jacobian[1] } = -root_;
    return true;
  }

 private:
  Matrix6 root_ = Matrix6::Zero();
  Vector6 right_ = Vector6::Zero();
};

}  // namespace

std::vector<Vector6> solve_forms(std::span<const ScanPairForm> forms, std::size_t scans,
                                 const std::vector<bool>& fixed) {
  std::vector<Vector6> twists(scans, Vector6::Zero());
  ceres::Problem problem;
  for (Vector6& twist : twists) problem.AddParameterBlock(twist.data(), 6);
  for (std::size_t i = 0; i < scans; ++i)
    if (fixed[i]) problem.SetParameterBlockConstant(twists[i].data());
  for (const ScanPairForm& form : forms)
    problem.AddResidualBlock(new FormCost(form), nullptr, twists[form.source].data(),
                             twists[form.target].data());
  ceres::Solver::Options options;
  options.num_threads = 1;  // the same bits every time
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 20;
  options.initial_trust_region_radius = 1e8;  // nearly a full step: the problem is quadratic
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  options.gradient_tolerance = 1e-16;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable())
    throw Error(Trouble::computation, "align_scans: the joint step failed: " + summary.message);
  return twists;
}

}  // namespace scan
