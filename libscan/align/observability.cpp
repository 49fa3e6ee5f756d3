// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/observability.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace scan {
namespace {

// Information below this share of the mean eigenvalue is rounding: normals kept as float are off by
// 6e-8, whose square is 4e-15; coordinates at 1e7 m with a size of 1 m by 2e-9.
constexpr double rounding_share = 1e-10;
// Weak below this multiple of what noise alone gives.
constexpr double noise_multiple = 4;
// So many points decide; more would cost time and tell nothing new.
constexpr std::size_t most_points = 4096;

Vector6 twist_row(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal) {
  Vector6 row;
  row << arm.cross(normal), normal;
  return row;
}

// Whether most of the points lie on a surface. Then those that do not are its edges and say
// nothing; else the points are marks of their own.
bool is_surface(std::span<const std::uint32_t> used, std::span<const LocalFit> fits) {
  std::size_t count = 0;
  for (const std::uint32_t i : used) count += fits[i].shape == LocalShape::surface;
  return 2 * count >= used.size();
}

std::optional<Eigen::Vector3d> tilt_of(const LocalFit& fit) {
  if (fit.shape != LocalShape::surface) return std::nullopt;
  return fit.tilt.cast<double>();
}

MotionInformation gather(std::span<const std::uint32_t> used,
                         std::span<const Eigen::Vector3d> points,
                         std::span<const Eigen::Vector3d> normals, std::span<const LocalFit> fits,
                         const DataFrame& frame) {
  MotionInformation sum;
  const bool marks = normals.empty() && !is_surface(used, fits);
  for (const std::uint32_t i : used) {
    const Eigen::Vector3d arm = (points[i] - frame.centre) / frame.size_m;
    const LocalFit& fit = fits[i];
    if (!normals.empty()) {
      sum.add_plane(arm, normals[i], tilt_of(fit));
    } else if (fit.shape == LocalShape::surface) {
      sum.add_plane(arm, fit.direction, tilt_of(fit));
    } else if (marks && fit.shape != LocalShape::unknown) {
      const Eigen::Vector3d along =
          fit.shape == LocalShape::line ? fit.direction : Eigen::Vector3d::Zero();
      sum.add_mark(arm, Eigen::Matrix3d::Identity() - along * along.transpose());
    }
  }
  return sum;
}

TwistBasis orthonormal(TwistBasis motions) {
  if (motions.cols() == 0) return motions;
  for (Eigen::Index i = 0; i < motions.cols(); ++i) motions.col(i).normalize();
  const Eigen::HouseholderQR<TwistBasis> qr(motions);
  return qr.householderQ() * TwistBasis::Identity(6, motions.cols());
}

std::string text_of(const Eigen::Vector3d& v, double smallest) {
  const Eigen::Vector3d w = (v.array().abs() < smallest).select(0, v);
  char text[96];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g)", w.x(), w.y(), w.z());
  return text;
}

// Turned so that the largest component is positive: a name does not depend on a sign.
Vector6 with_sign_of_largest(const Vector6& twist, bool slide) {
  const Eigen::Vector3d part = slide ? twist.tail<3>() : twist.head<3>();
  Eigen::Index largest;
  part.cwiseAbs().maxCoeff(&largest);
  return part[largest] < 0 ? Vector6(-twist) : twist;
}

// Axis and pitch of a twist: Murray, Li, Sastry 1994, section 2.3.
std::string name_turn(const Vector6& twist, const DataFrame& frame, const Eigen::Vector3d& origin) {
  const Eigen::Vector3d w = twist.head<3>(), t = twist.tail<3>() * frame.size_m;
  const Eigen::Vector3d axis = w.normalized();
  const Eigen::Vector3d through = origin + frame.centre + w.cross(t) / w.squaredNorm();
  const double pitch_m_per_rad = w.dot(t) / w.squaredNorm();
  std::string name = " about " + text_of(axis, 5e-4) + " through " + text_of(through, 0) + " m";
  if (std::abs(pitch_m_per_rad) < 0.05 * frame.size_m) return "turn" + name;
  char pitch[48];
  std::snprintf(pitch, sizeof pitch, " by %.4g m per turn", 2 * std::numbers::pi * pitch_m_per_rad);
  return "screw" + name + pitch;
}

}  // namespace

void MotionInformation::add_plane(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal,
                                  const std::optional<Eigen::Vector3d>& error) {
  const Vector6 row = twist_row(arm, normal);
  apparent_ += row * row.transpose();
  ++planes_;
  if (!error) return;
  const Vector6 off = twist_row(arm, *error);
  noise_ += off * off.transpose();
  ++drawn_;
}

void MotionInformation::add_mark(const Eigen::Vector3d& arm, const Eigen::Matrix3d& projector) {
  Eigen::Matrix<double, 3, 6> m;
  m << -cross_matrix(arm), Eigen::Matrix3d::Identity();
  apparent_ += m.transpose() * projector * m;
}

MotionInformation& MotionInformation::operator+=(const MotionInformation& other) {
  apparent_ += other.apparent_, noise_ += other.noise_;
  planes_ += other.planes_, drawn_ += other.drawn_;
  return *this;
}

Matrix6 MotionInformation::noise() const {
  return drawn_ > 0 ? Matrix6(planes_ / drawn_ * noise_) : Matrix6::Zero();
}

TwistBasis weak_motions(const MotionInformation& information) {
  const Matrix6& apparent = information.apparent();
  const Matrix6 limit =
      rounding_share * std::max(apparent.trace() / 6, 1e-300) * Matrix6::Identity() +
      noise_multiple * information.noise();
  // A v = mu limit v, weak where mu < 1.
  const Eigen::LLT<Matrix6> factor(limit);
  Matrix6 whitened = factor.matrixL().solve(apparent);
  whitened = factor.matrixL().solve(Matrix6(whitened.transpose()));
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(0.5 * (whitened + whitened.transpose()));
  const Eigen::Index count = (solver.eigenvalues().array() < 1).count();
  if (count == 0) return TwistBasis(6, 0);
  return orthonormal(factor.matrixU().solve(solver.eigenvectors().leftCols(count)));
}

TwistBasis weak_motions(std::span<const std::uint32_t> used,
                        std::span<const Eigen::Vector3d> points,
                        std::span<const Eigen::Vector3d> normals, std::span<const LocalFit> fits,
                        const DataFrame& frame) {
  const std::size_t stride = std::max<std::size_t>(1, used.size() / most_points);
  std::vector<std::uint32_t> sample;
  for (std::size_t i = 0; i < used.size(); i += stride) sample.push_back(used[i]);
  return weak_motions(gather(sample, points, normals, fits, frame));
}

// The velocity at the other centre: t + w x (c' - c).
TwistBasis carried(const TwistBasis& motions, const DataFrame& from, const DataFrame& to) {
  TwistBasis there = motions;
  for (Eigen::Index i = 0; i < motions.cols(); ++i) {
    const Eigen::Vector3d w = motions.col(i).head<3>();
    const Eigen::Vector3d t_m =
        from.size_m * motions.col(i).tail<3>() + w.cross(to.centre - from.centre);
    there.col(i).tail<3>() = t_m / to.size_m;
  }
  return orthonormal(there);
}

std::vector<std::string> name_motions(const TwistBasis& motions, const DataFrame& frame,
                                      const Eigen::Vector3d& origin) {
  std::vector<std::string> names;
  if (motions.cols() == 0) return names;
  // The combinations without rotation are slides; what is orthogonal to them are turns.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(motions.topRows<3>()),
                                              Eigen::ComputeThinU | Eigen::ComputeFullV);
  for (Eigen::Index i = motions.cols(); i-- > 0;) {
    const double turning = i < svd.singularValues().size() ? svd.singularValues()[i] : 0;
    const bool slide = turning < 0.2;
    const Vector6 twist = with_sign_of_largest(motions * svd.matrixV().col(i), slide);
    names.push_back(slide ? "slide along " + text_of(twist.tail<3>().normalized(), 5e-4)
                          : name_turn(twist, frame, origin));
  }
  return names;
}

Vector6 solve_withholding(const Matrix6& a, const Vector6& b, const TwistBasis& withheld) {
  const Matrix6 projector = complement_projector(withheld);
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(projector * a * projector);
  const Vector6 along = solver.eigenvectors().transpose() * (projector * b);
  const double least = 1e-12 * solver.eigenvalues()[5];
  Vector6 x = Vector6::Zero();
  for (int i = 0; i < 6; ++i)
    if (solver.eigenvalues()[i] > least)
      x += along[i] / solver.eigenvalues()[i] * solver.eigenvectors().col(i);
  return projector * x;
}

Matrix6 complement_projector(const TwistBasis& withheld) {
  return Matrix6::Identity() - withheld * withheld.transpose();
}

}  // namespace scan
