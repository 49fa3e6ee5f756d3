// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/rigid_fit.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "libscan/core/error.h"

namespace scan {
namespace {

using Points = std::span<const Eigen::Vector3d>;

void check_input(Points source, Points target, std::span<const double> weights) {
  if (source.size() != target.size() || (!weights.empty() && weights.size() != source.size()))
    throw Error(Trouble::input, "rigid_fit: " + std::to_string(source.size()) + " source points, " +
                                    std::to_string(target.size()) + " target points, " +
                                    std::to_string(weights.size()) + " weights; must be equal");
  for (std::size_t i = 0; i < source.size(); ++i) {
    const double weight = weights.empty() ? 1 : weights[i];
    if (!source[i].allFinite() || !target[i].allFinite() || !std::isfinite(weight) || weight < 0)
      throw Error(Trouble::input, "rigid_fit: pair " + std::to_string(i) +
                                      " is not finite or its weight is negative");
  }
}

// Relative to the first point, so that the sum keeps its digits far from the origin.
Eigen::Vector3d weighted_mean(Points points, std::span<const double> weights, double total) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i)
    sum += (weights.empty() ? 1 : weights[i]) * (points[i] - points[0]);
  return points[0] + sum / total;
}

struct Moments {
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();  // sum of w (target - mean)(source - mean)^T
  double source2 = 0, target2 = 0;                  // sums of w |.|^2 about the means
};

Moments centred_moments(Points source, Points target, std::span<const double> weights,
                        const Eigen::Vector3d& source_mean, const Eigen::Vector3d& target_mean) {
  Moments m;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const double w = weights.empty() ? 1 : weights[i];
    const Eigen::Vector3d s = source[i] - source_mean, t = target[i] - target_mean;
    m.cross += w * t * s.transpose();
    m.source2 += w * s.squaredNorm();
    m.target2 += w * t.squaredNorm();
  }
  return m;
}

// Singular values that rounding of the coordinates alone would give count as zero.
int rank_of(const Eigen::Vector3d& singular, const Moments& m, double total,
            double largest_coordinate_m) {
  const double rounding_m = 4 * std::numeric_limits<double>::epsilon() * largest_coordinate_m;
  if (m.source2 <= total * rounding_m * rounding_m || m.target2 <= total * rounding_m * rounding_m)
    return 0;
  const double limit = 1e-12 * std::sqrt(m.source2 * m.target2) + total * rounding_m * rounding_m;
  return static_cast<int>((singular.array() > limit).count());
}

// Umeyama 1991, eq. 40-43: R = U diag(1, 1, det(U V^T)) V^T. Rank 1: the shortest turn between the two
// lines. The quaternion brings the product of two nearly orthogonal factors back onto SO(3).
Eigen::Matrix3d best_rotation(const Eigen::JacobiSVD<Eigen::Matrix3d>& svd, int rank) {
  if (rank == 0) return Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d &u = svd.matrixU(), &v = svd.matrixV();
  if (rank == 1)
    return Eigen::Quaterniond::FromTwoVectors(v.col(0), u.col(0)).normalized().toRotationMatrix();
  const double sign = (u * v.transpose()).determinant() < 0 ? -1 : 1;
  const Eigen::Matrix3d rotation = u * Eigen::Vector3d(1, 1, sign).asDiagonal() * v.transpose();
  return Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
}

}  // namespace

RigidFit rigid_fit(std::span<const Eigen::Vector3d> source, std::span<const Eigen::Vector3d> target,
                   std::span<const double> weights) {
  check_input(source, target, weights);
  RigidFit fit;
  double total = weights.empty() ? static_cast<double>(source.size()) : 0;
  for (const double weight : weights) total += weight;
  if (!(total > 0)) return fit;
  const Eigen::Vector3d source_mean = weighted_mean(source, weights, total);
  const Eigen::Vector3d target_mean = weighted_mean(target, weights, total);
  const Moments moments = centred_moments(source, target, weights, source_mean, target_mean);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments.cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double largest = std::max(source_mean.cwiseAbs().maxCoeff(), target_mean.cwiseAbs().maxCoeff());
  fit.rank = rank_of(svd.singularValues(), moments, total, largest);
  const Eigen::Matrix3d rotation = best_rotation(svd, fit.rank);
  fit.target_from_source = make_pose(rotation, target_mean - rotation * source_mean);
  double sum = 0;
  for (std::size_t i = 0; i < source.size(); ++i)
    sum += (weights.empty() ? 1 : weights[i]) *
           (rotation * (source[i] - source_mean) - (target[i] - target_mean)).squaredNorm();
  fit.rms_m = std::sqrt(sum / total);
  return fit;
}

}  // namespace scan
