// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/board_bundle.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numeric>

#include "libscan/core/error.h"

namespace scan::calibrating {
namespace {

constexpr int twist_unknowns = 6;

// Normal equations with the pictures' blocks: [A B; B^T D] step = -gradient.
struct PictureBlock {
  Eigen::MatrixXd cross;  // shared x 6
  Matrix6 own = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
};
struct NormalEquations {
  Eigen::MatrixXd shared;
  Eigen::VectorXd gradient;
  std::vector<PictureBlock> pictures;
};
struct Step {
  Eigen::VectorXd shared;
  std::vector<Vector6> poses;
};

int shared_size(const Bundle& bundle) {
  const int cameras = static_cast<int>(bundle.cameras.size());
  return camera_unknowns * cameras + (cameras > 1 ? twist_unknowns : 0);
}

// Which of the shared unknowns are sought.
std::vector<int> sought(const Bundle& bundle) {
  std::vector<int> indices;
  if (bundle.fixed_cameras) return indices;
  for (int i = 0; i < shared_size(bundle); ++i) {
    const bool of_pair = i >= camera_unknowns * static_cast<int>(bundle.cameras.size());
    if (of_pair || i % camera_unknowns < 4 + bundle.distortion_terms) indices.push_back(i);
  }
  return indices;
}

// d(exp(twist) x) / d twist at zero.
Eigen::Matrix<double, 3, twist_unknowns> by_twist(const Eigen::Vector3d& x) {
  Eigen::Matrix<double, 3, twist_unknowns> derivative;
  derivative << -cross_matrix(x), Eigen::Matrix3d::Identity();
  return derivative;
}

Pose camera_from_first(const Bundle& bundle, std::size_t camera) {
  return camera == 0 ? Pose::Identity() : bundle.second_from_first;
}

double squares_of(const Bundle& bundle, const BoardPicture& picture) {
  double sum = 0;
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    const Pose camera_from_board = camera_from_first(bundle, c) * picture.first_from_board;
    for (std::size_t k = 0; k < bundle.board_m.size(); ++k) {
      const auto pixel = project(bundle.cameras[c], camera_from_board * bundle.board_m[k]);
      if (!pixel) return std::numeric_limits<double>::infinity();
      sum += (*pixel - picture.corners_px[c][k]).squaredNorm();
    }
  }
  return sum;
}

double squares_of(const Bundle& bundle) {
  double sum = 0;
  for (const BoardPicture& picture : bundle.pictures) sum += squares_of(bundle, picture);
  return sum;
}

void add_corner(const Bundle& bundle, std::size_t camera, const Eigen::Vector3d& x_in_first,
                const Eigen::Vector2d& corner_px, NormalEquations& equations, PictureBlock& block) {
  const Pose pose = camera_from_first(bundle, camera);
  const Eigen::Vector3d x = pose * x_in_first;
  const Projection seen = project_with_derivatives(bundle.cameras[camera], x);
  Eigen::Matrix<double, 2, Eigen::Dynamic> shared =
      Eigen::Matrix<double, 2, Eigen::Dynamic>::Zero(2, shared_size(bundle));
  shared.middleCols<camera_unknowns>(camera_unknowns * Eigen::Index(camera)) = seen.by_camera;
  if (camera > 0) shared.rightCols<twist_unknowns>() = seen.by_point * by_twist(x);
  const Eigen::Matrix<double, 2, twist_unknowns> own =
      seen.by_point * pose.linear() * by_twist(x_in_first);
  const Eigen::Vector2d residual = seen.pixel - corner_px;
  equations.shared += shared.transpose() * shared;
  equations.gradient += shared.transpose() * residual;
  block.cross += shared.transpose() * own;
  block.own += own.transpose() * own;
  block.gradient += own.transpose() * residual;
}

NormalEquations equations_of(const Bundle& bundle) {
  const int size = shared_size(bundle);
  NormalEquations equations{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size), {}};
  for (const BoardPicture& picture : bundle.pictures) {
    PictureBlock block{Eigen::MatrixXd::Zero(size, twist_unknowns)};
    for (std::size_t c = 0; c < bundle.cameras.size(); ++c)
      for (std::size_t k = 0; k < bundle.board_m.size(); ++k)
        add_corner(bundle, c, picture.first_from_board * bundle.board_m[k],
                   picture.corners_px[c][k], equations, block);
    equations.pictures.push_back(std::move(block));
  }
  return equations;
}

// The shared part once the poses are eliminated, of what is sought.
Eigen::MatrixXd reduced(const NormalEquations& equations, const std::vector<int>& indices) {
  Eigen::MatrixXd schur = equations.shared;
  for (const PictureBlock& block : equations.pictures)
    schur -= block.cross * block.own.ldlt().solve(block.cross.transpose());
  return schur(indices, indices);
}

// Diagonals times 1 + damping (Marquardt 1963), which keeps the units apart.
Step solve(NormalEquations equations, const std::vector<int>& indices, double damping) {
  equations.shared.diagonal() *= 1 + damping;
  Eigen::VectorXd right = -equations.gradient;
  for (PictureBlock& block : equations.pictures) {
    block.own.diagonal() *= 1 + damping;
    right += block.cross * block.own.ldlt().solve(block.gradient);
  }
  Step step{Eigen::VectorXd::Zero(equations.gradient.size()), {}};
  if (!indices.empty()) {
    const Eigen::VectorXd moves =
        reduced(equations, indices).ldlt().solve(Eigen::VectorXd(right(indices)));
    step.shared(indices) = moves;
  }
  for (const PictureBlock& block : equations.pictures)
    step.poses.push_back(
        block.own.ldlt().solve(-block.gradient - block.cross.transpose() * step.shared));
  return step;
}

Bundle moved(Bundle bundle, const Step& step) {
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    const CameraVector by = step.shared.segment<camera_unknowns>(camera_unknowns * Eigen::Index(c));
    bundle.cameras[c] = with_unknowns(bundle.cameras[c], unknowns_of(bundle.cameras[c]) + by);
  }
  if (bundle.cameras.size() > 1)
    bundle.second_from_first =
        exp(step.shared.tail<twist_unknowns>().eval()) * bundle.second_from_first;
  for (std::size_t i = 0; i < bundle.pictures.size(); ++i)
    bundle.pictures[i].first_from_board = exp(step.poses[i]) * bundle.pictures[i].first_from_board;
  return bundle;
}

double predicted_decrease(const NormalEquations& equations, const Step& step) {
  double decrease = -equations.gradient.dot(step.shared);
  for (std::size_t i = 0; i < step.poses.size(); ++i)
    decrease -= equations.pictures[i].gradient.dot(step.poses[i]);
  return decrease;
}

// Inverse of a normal matrix whose unknowns differ in unit: scaled to a diagonal of ones, and no
// eigenvalue taken below rounding.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& normal) {
  if (normal.rows() == 0) return normal;
  const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * normal *
                                                              scale.asDiagonal());
  const Eigen::MatrixXd directions = scale.asDiagonal() * solver.eigenvectors();
  const Eigen::VectorXd values = solver.eigenvalues().cwiseMax(1e-15);
  return directions * values.cwiseInverse().asDiagonal() * directions.transpose();
}

void add_figures(const std::vector<int>& indices, BundleFit& fit) {
  const Bundle& bundle = fit.bundle;
  const NormalEquations equations = equations_of(bundle);
  const int size = shared_size(bundle);
  fit.cofactor = Eigen::MatrixXd::Zero(size, size);
  fit.cofactor(indices, indices) = inverse_of(reduced(equations, indices));
  const double seen = static_cast<double>(bundle.cameras.size() * bundle.board_m.size());
  double sum = 0;
  for (std::size_t i = 0; i < bundle.pictures.size(); ++i) {
    fit.pose_cofactors.push_back(inverse_of(equations.pictures[i].own));
    const double squares = squares_of(bundle, bundle.pictures[i]);
    fit.picture_rms_px.push_back(std::sqrt(squares / seen));
    sum += squares;
  }
  const double count = seen * static_cast<double>(bundle.pictures.size());
  const double unknowns = static_cast<double>(indices.size() + 6 * bundle.pictures.size());
  fit.rms_px = std::sqrt(sum / count);
  fit.sigma_px = std::sqrt(sum / (2 * count - unknowns));
}

void check(const Bundle& bundle, std::size_t unknowns) {
  const std::size_t coordinates =
      2 * bundle.pictures.size() * bundle.cameras.size() * bundle.board_m.size();
  if (coordinates > unknowns) return;
  throw Error(Trouble::computation, "calibration: " + std::to_string(coordinates) +
                                        " coordinates of corners, must be more than the " +
                                        std::to_string(unknowns) + " unknowns");
}

}  // namespace

CameraVector unknowns_of(const Camera& c) {
  CameraVector unknowns;
  unknowns << c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2, c.k3;
  return unknowns;
}

Camera with_unknowns(Camera camera, const CameraVector& u) {
  double* const fields[] = {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px, &camera.k1,
                            &camera.k2,    &camera.p1,    &camera.p2,    &camera.k3};
  for (int i = 0; i < camera_unknowns; ++i) *fields[i] = u[i];
  return camera;
}

// Brown's model as in libscan/core/camera.h.
Projection project_with_derivatives(const Camera& c, const Eigen::Vector3d& point) {
  const double x = point.x() / point.z(), y = point.y() / point.z();
  const double r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  const double radial = 1 + c.k1 * r2 + c.k2 * r4 + c.k3 * r6;
  const double slope = c.k1 + 2 * c.k2 * r2 + 3 * c.k3 * r4;  // d radial / d r2
  const Eigen::Vector2d focal(c.fx_px, c.fy_px);
  const Eigen::Vector2d bent(x * radial + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x),
                             y * radial + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y);
  Eigen::Matrix2d by_slope;  // of bent by (x, y)
  by_slope << radial + 2 * x * x * slope + 2 * c.p1 * y + 6 * c.p2 * x,
      2 * x * y * slope + 2 * c.p1 * x + 2 * c.p2 * y,
      2 * x * y * slope + 2 * c.p1 * x + 2 * c.p2 * y,
      radial + 2 * y * y * slope + 6 * c.p1 * y + 2 * c.p2 * x;
  Eigen::Matrix<double, 2, 3> slope_by_point;
  slope_by_point << 1, 0, -x, 0, 1, -y;
  slope_by_point /= point.z();
  Eigen::Matrix<double, 2, 5> by_terms;
  by_terms << x * r2, x * r4, 2 * x * y, r2 + 2 * x * x, x * r6,  //
      y * r2, y * r4, r2 + 2 * y * y, 2 * x * y, y * r6;
  Projection seen;
  seen.pixel = focal.cwiseProduct(bent) + Eigen::Vector2d(c.cx_px, c.cy_px);
  seen.by_point = focal.asDiagonal() * by_slope * slope_by_point;
  seen.by_camera << Eigen::Matrix2d(bent.asDiagonal()), Eigen::Matrix2d::Identity(),
      focal.asDiagonal() * by_terms;
  return seen;
}

BundleFit adjust(const Bundle& guess) {
  constexpr int most_iterations = 200;
  const std::vector<int> indices = sought(guess);
  check(guess, indices.size() + twist_unknowns * guess.pictures.size());
  BundleFit fit{.bundle = guess};
  double squares = squares_of(guess), damping = 1e-3;
  NormalEquations equations = equations_of(guess);
  while (fit.iterations < most_iterations && !fit.converged) {
    ++fit.iterations;
    const Step step = solve(equations, indices, damping);
    const Bundle trial = moved(fit.bundle, step);
    const double trial_squares = squares_of(trial);
    // the rest of the way is less than a thousandth of a sigma, or below rounding
    fit.converged =
        std::isfinite(squares) && predicted_decrease(equations, step) <= 1e-12 * squares + 1e-20;
    if (trial_squares < squares) {
      fit.bundle = trial;
      squares = trial_squares;
      equations = equations_of(trial);
      damping = std::max(damping / 10, 1e-12);
    } else {
      damping *= 10;
    }
  }
  add_figures(indices, fit);
  return fit;
}

}  // namespace scan::calibrating
