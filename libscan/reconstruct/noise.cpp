// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/noise.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "libscan/core/parallel.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr std::size_t least_neighbours = 24, most_neighbours = 1536, wanted_fits = 500;
constexpr double radius_in_sigmas = 5;
constexpr int unknowns = 6;  // of z = a + b x + c y + d x^2 + e x y + f y^2

struct Residual {
  double sigma = 0;
  double radius = 0;
};

Residual quadric_residual(std::span<const Eigen::Vector3d> points,
                          std::span<const Neighbour> found) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Neighbour& n : found) mean += points[n.index];
  mean /= static_cast<double>(found.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Neighbour& n : found) {
    const Eigen::Vector3d d = points[n.index] - mean;
    spread += d * d.transpose();
  }
  const Eigen::Matrix3d frame =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  const double radius = std::sqrt(found.back().distance2_m2);
  using Row = Eigen::Matrix<double, unknowns, 1>;
  Eigen::Matrix<double, unknowns, unknowns> normal_matrix =
      1e-12 * Eigen::Matrix<double, unknowns, unknowns>::Identity();
  Row right = Row::Zero();
  double squares = 0;
  for (const Neighbour& n : found) {
    const Eigen::Vector3d x = frame.transpose() * (points[n.index] - mean) / radius;
    Row row;
    row << 1, x[1], x[2], x[1] * x[1], x[1] * x[2], x[2] * x[2];
    normal_matrix += row * row.transpose();
    right += x[0] * row;
    squares += x[0] * x[0];
  }
  const double left = squares - right.dot(normal_matrix.ldlt().solve(right));
  return {radius * std::sqrt(std::max(0.0, left) / static_cast<double>(found.size() - unknowns)),
          radius};
}

}  // namespace

double estimate_sigma(std::span<const Eigen::Vector3d> points) {
  const KdTree tree(points);
  const std::size_t step = std::max<std::size_t>(1, points.size() / wanted_fits);
  std::vector<double> sigmas((points.size() + step - 1) / step);
  parallel_for(
      sigmas.size(),
      [&](std::size_t i) {
        std::vector<Neighbour> found;
        for (std::size_t k = least_neighbours;; k *= 2) {
          const std::size_t count = std::min(k, points.size());
          tree.k_nearest(points[i * step], count, found);
          const Residual residual = quadric_residual(points, found);
          sigmas[i] = residual.sigma;
          if (residual.radius >= radius_in_sigmas * residual.sigma || count == points.size() ||
              2 * k > most_neighbours)
            break;
        }
      },
      8);
  const auto middle = sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2);
  std::nth_element(sigmas.begin(), middle, sigmas.end());
  return *middle;
}

}  // namespace scan
