// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/stripe_plane.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace scan::calibrating {
namespace {

using Row6 = Eigen::Matrix<double, 1, 6>;

// The longest direction of the points, the plane's normal by principal axes, and the spread.
StripePlane principal_plane(std::span<const BoardStripe> stripes) {
  StripePlane plane;
  double count = 0;
  for (const BoardStripe& stripe : stripes)
    for (const StripePoint& point : stripe.points) plane.centre_m += point.place_m, ++count;
  plane.centre_m /= count;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const BoardStripe& stripe : stripes)
    for (const StripePoint& point : stripe.points) {
      const Eigen::Vector3d from = point.place_m - plane.centre_m;
      scatter += from * from.transpose();
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  plane.normal = solver.eigenvectors().col(0);
  plane.axes << solver.eigenvectors().col(1), solver.eigenvectors().col(2);
  plane.spread = std::sqrt(std::max(0.0, solver.eigenvalues()[1]) / solver.eigenvalues()[2]);
  return plane;
}

struct Equations {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double chi2 = 0;
  double squares_m2 = 0;
  std::size_t count = 0;
};

// How the distance of a point from the light plane changes with the board's pose: the point moves
// along its ray r by m . (w x p + t) / (m . r), m the board's normal.
Row6 by_pose(const StripePlane& plane, const BoardStripe& stripe, const Eigen::Vector3d& point) {
  const double lever = plane.normal.dot(point) / stripe.board_normal.dot(point);
  Row6 row;
  row << point.cross(stripe.board_normal).transpose(), stripe.board_normal.transpose();
  return lever * row;
}

// Adds one board's points, its pose errors eliminated (Woodbury).
void add_stripe(const StripePlane& plane, const BoardStripe& stripe, Equations& sum) {
  Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 6> cross = Eigen::Matrix<double, 3, 6>::Zero();
  Matrix6 pose = stripe.pose_covariance.inverse();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  Vector6 pose_right = Vector6::Zero();
  double squares = 0;
  for (const StripePoint& point : stripe.points) {
    const Eigen::Vector3d from = point.place_m - plane.centre_m;
    const double distance_m = plane.normal.dot(from) - plane.offset_m;
    const double sigma_m = plane.normal.dot(point.shift_m);
    const double weight = 1 / (sigma_m * sigma_m);
    const Eigen::Vector3d slope(plane.axes.col(0).dot(from), plane.axes.col(1).dot(from), -1);
    const Row6 turn = by_pose(plane, stripe, point.place_m);
    own += weight * slope * slope.transpose();
    cross += weight * slope * turn;
    pose += weight * turn.transpose() * turn;
    right -= weight * distance_m * slope;
    pose_right -= weight * distance_m * turn.transpose();
    squares += weight * distance_m * distance_m;
    sum.squares_m2 += distance_m * distance_m;
  }
  const Eigen::LDLT<Matrix6> factor(pose);
  sum.normal += own - cross * factor.solve(cross.transpose());
  sum.right += right - cross * factor.solve(pose_right);
  sum.chi2 += squares - pose_right.dot(factor.solve(pose_right));
  sum.count += stripe.points.size();
}

Equations equations_of(const StripePlane& plane, std::span<const BoardStripe> stripes) {
  Equations sum;
  for (const BoardStripe& stripe : stripes) add_stripe(plane, stripe, sum);
  return sum;
}

void move(StripePlane& plane, const Eigen::Vector3d& step) {
  plane.normal = (plane.normal + plane.axes * step.head<2>()).normalized();
  plane.offset_m += step.z();
  plane.axes.col(0) -= plane.normal * plane.normal.dot(plane.axes.col(0));
  plane.axes.col(0).normalize();
  plane.axes.col(1) = plane.normal.cross(plane.axes.col(0));
}

}  // namespace

StripePlane fit_stripe_plane(std::span<const BoardStripe> stripes, double min_spread) {
  constexpr int most_iterations = 20;  // quadratic: four serve
  StripePlane plane = principal_plane(stripes);
  if (!(plane.spread >= min_spread)) return plane;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Equations sum = equations_of(plane, stripes);
    const Eigen::Vector3d step = sum.normal.ldlt().solve(sum.right);
    move(plane, step);
    if (step.dot(sum.normal * step) < 1e-12) break;  // a millionth of a sigma
  }
  const Equations sum = equations_of(plane, stripes);
  plane.covariance = sum.normal.inverse();
  plane.misfit = std::sqrt(sum.chi2 / static_cast<double>(sum.count - 3));
  plane.rms_m = std::sqrt(sum.squares_m2 / static_cast<double>(sum.count));
  return plane;
}

}  // namespace scan::calibrating
