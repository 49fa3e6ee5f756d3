// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/pose_graph.h"

#include <ceres/ceres.h>
#include <ceres/crs_matrix.h>
#include <ceres/rotation.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "libscan/align/pose_edge.h"
#include "libscan/align/selected_inverse.h"
#include "libscan/align/spanning_tree.h"
#include "libscan/core/error.h"

namespace scan {
namespace {

constexpr double open_share = 1e-12;  // of what an edge fixes best; motions below count as open
constexpr double narrowing = 1.4;     // of the limit per round (Yang et al. 2020, remark 5)
constexpr int most_final_rounds = 10;
constexpr double sharp = 1e12;  // blur of a limit that is none

// A scan's pose moved by (rotation about its origin, translation), along the world's axes.
Pose moved(const Pose& pose, const Vector6& x) {
  Vector6 turn = Vector6::Zero();
  turn.head<3>() = x.head<3>();
  return make_pose(nearest_rotation(exp(turn).linear() * pose.linear()),
                   pose.translation() + x.tail<3>());
}

// sqrt(weight) S e, e the left twist by which the poses differ from the edge: rotation vector and
// translation of P Z^-1, which to first order is its logarithm.
struct EdgeError {
  const PoseEdge* edge;
  const Pose* source;
  const Pose* target;
  Matrix6 root;
  const double* weight;

  template <class T>
  bool operator()(const T* x_source, const T* x_target, T* residual) const {
    using Matrix3 = Eigen::Matrix<T, 3, 3>;
    using Vector3 = Eigen::Matrix<T, 3, 1>;
    Matrix3 turn_source, turn_target;
    ceres::AngleAxisToRotationMatrix(x_source, turn_source.data());
    ceres::AngleAxisToRotationMatrix(x_target, turn_target.data());
    const Matrix3 to_target = (turn_target * target->linear().cast<T>()).transpose();
    const Vector3 t_source = source->translation() + Eigen::Map<const Vector3>(x_source + 3);
    const Vector3 t_target = target->translation() + Eigen::Map<const Vector3>(x_target + 3);
    const Matrix3 rotation = to_target * turn_source * source->linear().cast<T>() *
                             edge->target_from_source.linear().transpose().cast<T>();
    Eigen::Matrix<T, 6, 1> e;
    ceres::RotationMatrixToAngleAxis(rotation.data(), e.data());
    e.template tail<3>() = to_target * (t_source - t_target) -
                           rotation * edge->target_from_source.translation().cast<T>();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> out(residual);
    out = std::sqrt(*weight) * (root.cast<T>() * e);
    return true;
  }
};

// The cost is a chi-square: a change by less than `least` means nothing.
class EnoughDone : public ceres::IterationCallback {
 public:
  explicit EnoughDone(double least) : least_(least) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& state) override {
    const bool done = state.iteration > 0 && state.step_is_successful && state.cost_change < least_;
    return done ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  double least_;
};

// Weight of a truncated square whose limit is blurred by mu (Yang et al. 2020, equation 14).
double truncated_weight(double chi_square, double limit, double mu) {
  if (chi_square <= mu / (mu + 1) * limit) return 1;
  if (chi_square >= (mu + 1) / mu * limit) return 0;
  // At the upper end rounding may put it below zero.
  return std::max(0.0, std::sqrt(limit * mu * (mu + 1) / chi_square) - mu);
}

ceres::Solver::Options solver_options() {
  ceres::Solver::Options options;
  options.num_threads = 1;  // the same bits every time
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.gradient_tolerance = 0;  // it has units, the cost has none
  return options;
}

class Graph {
 public:
  Graph(std::span<const Pose> starts, std::span<const PoseEdge> edges, std::size_t anchor);
  void narrow(std::size_t tree_depth);
  PoseGraph result(std::span<const Pose> starts);

 private:
  void solve(double least_change = 1e-12);
  void weigh(double mu);
  bool all_agree();
  bool accept();
  void find_tied();
  Eigen::SparseMatrix<double> information(std::vector<Eigen::Index>& row);
  void set_covariances();

  std::span<const PoseEdge> edges_;
  std::size_t anchor_;
  PoseGraph out_;
  std::vector<Vector6> x_;  // motions of the scans in the present solve
  std::vector<double> weights_, limits_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> blocks_;
};

Graph::Graph(std::span<const Pose> starts, std::span<const PoseEdge> edges, std::size_t anchor)
    : edges_(edges),
      anchor_(anchor),
      x_(starts.size(), Vector6::Zero()),
      weights_(edges.size(), 1) {
  out_.world_from_scan.assign(starts.begin(), starts.end());
  out_.tied.assign(starts.size(), false);
  out_.accepted.assign(edges.size(), true);
  out_.chi_square.assign(edges.size(), 0);
  out_.covariance.resize(starts.size());
  for (Vector6& x : x_) problem_.AddParameterBlock(x.data(), 6);
  problem_.SetParameterBlockConstant(x_[anchor].data());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const PoseEdge& edge = edges[i];
    limits_.push_back(chi_square_limit(edge.information));
    auto* error =
        new EdgeError{&edge, &out_.world_from_scan[edge.source], &out_.world_from_scan[edge.target],
                      root_of(edge.information), &weights_[i]};
    blocks_.push_back(
        problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<EdgeError, 6, 6, 6>(error),
                                  nullptr, x_[edge.source].data(), x_[edge.target].data()));
  }
}

// Moves the poses to the minimum at the present weights.
void Graph::solve(double least_change) {
  EnoughDone enough(least_change);
  ceres::Solver::Options options = solver_options();
  options.callbacks.push_back(&enough);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
  if (!summary.IsSolutionUsable())
    throw Error(Trouble::computation, "solve_pose_graph: " + summary.message);
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (i == anchor_ || x_[i].isZero(0)) continue;
    out_.world_from_scan[i] = moved(out_.world_from_scan[i], x_[i]);
    x_[i].setZero();
  }
}

void Graph::weigh(double mu) {
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    weights_[i] = 1;
    double half = 0;
    problem_.EvaluateResidualBlock(blocks_[i], false, &half, nullptr, nullptr);
    out_.chi_square[i] = 2 * half;
    weights_[i] = truncated_weight(out_.chi_square[i], limits_[i], mu);
  }
}

// The limit starts where a walk of `tree_depth` edges there and back, all off the same way, may
// lead, and ends at the edges' own.
void Graph::narrow(std::size_t tree_depth) {
  if (all_agree()) return;
  const double walk = 2.0 * static_cast<double>(tree_depth) + 1;
  for (double mu = 1 / (walk * walk); mu < 100; mu *= narrowing) {
    weigh(mu);
    solve(1e-2);  // the next round moves the minimum by more
  }
  for (int round = 0; round < most_final_rounds; ++round) {
    if (!accept() && round > 0) break;
    solve();
  }
  weigh(sharp);
}

// Least squares over all edges, kept where each lies within its limit: nothing is to be narrowed.
bool Graph::all_agree() {
  const std::vector<Pose> before = out_.world_from_scan;
  solve();
  weigh(sharp);
  bool agree = true;
  for (std::size_t i = 0; i < edges_.size(); ++i) agree = agree && out_.chi_square[i] <= limits_[i];
  if (!agree) out_.world_from_scan = before;
  return agree;
}

// True if an edge changed sides.
bool Graph::accept() {
  weigh(sharp);
  bool changed = false;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const bool accepted = out_.chi_square[i] <= limits_[i];
    changed = changed || accepted != out_.accepted[i];
    out_.accepted[i] = accepted;
    weights_[i] = accepted ? 1 : 0;
  }
  return changed;
}

void Graph::find_tied() {
  out_.tied[anchor_] = true;
  for (bool grew = true; grew;) {
    grew = false;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const PoseEdge& edge = edges_[i];
      if (!out_.accepted[i] || out_.tied[edge.source] == out_.tied[edge.target]) continue;
      out_.tied[edge.source] = out_.tied[edge.target] = grew = true;
    }
  }
}

// J^T J of the tied scans but the anchor, six rows each; `row` says where a scan's begin.
Eigen::SparseMatrix<double> Graph::information(std::vector<Eigen::Index>& row) {
  std::vector<double*> blocks;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (!out_.tied[i] || i == anchor_) continue;
    row[i] = 6 * static_cast<Eigen::Index>(blocks.size());
    blocks.push_back(x_[i].data());
  }
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = blocks;
  ceres::CRSMatrix rows;
  problem_.Evaluate(options, nullptr, nullptr, nullptr, &rows);
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> jacobian(
      rows.num_rows, rows.num_cols, static_cast<Eigen::Index>(rows.values.size()), rows.rows.data(),
      rows.cols.data(), rows.values.data());
  return jacobian.transpose() * jacobian;
}

// From the inverse of J^T J at the minimum, its columns scaled to one unit.
void Graph::set_covariances() {
  std::vector<Eigen::Index> row(x_.size(), -1);
  const Eigen::SparseMatrix<double> whole = information(row);
  const Eigen::VectorXd scale = whole.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SparseMatrix<double> scaled = scale.asDiagonal() * whole * scale.asDiagonal();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(scaled);
  if (factor.info() != Eigen::Success || !(factor.vectorD().array() > open_share).all()) return;
  const std::vector<Matrix6> blocks = inverse_blocks(scaled);
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (i == anchor_) out_.covariance[i] = Matrix6::Zero();
    if (row[i] < 0) continue;
    const auto own = scale.segment<6>(row[i]).asDiagonal();
    out_.covariance[i] = own * blocks[std::size_t(row[i] / 6)] * own;
  }
}

PoseGraph Graph::result(std::span<const Pose> starts) {
  for (std::size_t i = 0; i < edges_.size(); ++i) weights_[i] = out_.accepted[i] ? 1 : 0;
  find_tied();
  set_covariances();
  for (std::size_t i = 0; i < starts.size(); ++i)
    if (!out_.tied[i]) out_.world_from_scan[i] = starts[i];
  return std::move(out_);
}

}  // namespace

PoseGraph solve_pose_graph(std::span<const Pose> starts, std::span<const PoseEdge> edges,
                           std::size_t anchor) {
  check(edges, starts.size(), anchor);
  const SpanningTree tree = spanning_tree(starts, edges, anchor);
  Graph graph(tree.world_from_scan, edges, anchor);
  graph.narrow(tree.depth);
  return graph.result(starts);
}

}  // namespace scan
