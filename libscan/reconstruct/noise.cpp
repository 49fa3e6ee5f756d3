// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/noise.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "libscan/core/median.h"
#include "libscan/core/parallel.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr std::size_t least_neighbours = 24, most_neighbours = 1536, wanted_fits = 2000;
constexpr double radius_in_sigmas = 5;
constexpr int unknowns = 6;  // of z = a + b x + c y + d x^2 + e x y + f y^2
// Pairs of points nearer to each other than these, in spacings: independent points have three far
// pairs for a near one; of points in clumps it is not known whether they share their errors.
constexpr double near_pair = 0.25, far_pair = 0.5;
constexpr std::size_t least_pairs = 200;
constexpr double scatter_share = 0.7;  // of the residual, for it to be taken for scatter

using Quadric = Eigen::Matrix<double, unknowns, 1>;

Quadric row_of(const Eigen::Vector3d& x) {
  Quadric row;
  row << 1, x[1], x[2], x[1] * x[1], x[1] * x[2], x[2] * x[2];
  return row;
}

// A quadric over the tangent plane of some points.
struct Fit {
  std::vector<Eigen::Vector3d> points;  // z, x, y from their mean, in radii
  std::vector<double> left;             // of z, in radii
  double radius = 0;
  double sigma = 0;  // of what is left, per degree of freedom; in the points' unit
};

Fit fit_quadric(std::span<const Eigen::Vector3d> points, std::span<const Neighbour> found) {
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
  Fit fit{.points = {}, .left = {}, .radius = std::sqrt(found.back().distance2_m2)};
  Eigen::Matrix<double, unknowns, unknowns> normal_matrix =
      1e-12 * Eigen::Matrix<double, unknowns, unknowns>::Identity();
  Quadric right = Quadric::Zero();
  for (const Neighbour& n : found) {
    fit.points.push_back(frame.transpose() * (points[n.index] - mean) / fit.radius);
    const Quadric row = row_of(fit.points.back());
    normal_matrix += row * row.transpose();
    right += fit.points.back()[0] * row;
  }
  const Quadric q = normal_matrix.ldlt().solve(right);
  double squares = 0;
  for (const Eigen::Vector3d& x : fit.points) {
    fit.left.push_back(x[0] - q.dot(row_of(x)));
    squares += fit.left.back() * fit.left.back();
  }
  fit.sigma = fit.radius * std::sqrt(squares / static_cast<double>(found.size() - unknowns));
  return fit;
}

// Half the squared differences of what a fit leaves of two points beside each other.
struct PairSquares {
  std::vector<double> near, far;
  void add(const PairSquares& other) {
    near.insert(near.end(), other.near.begin(), other.near.end());
    far.insert(far.end(), other.far.begin(), other.far.end());
  }
};

PairSquares pair_squares(const Fit& fit) {
  PairSquares squares;
  const double spacing2 = std::numbers::pi / static_cast<double>(fit.points.size());
  for (std::size_t i = 0; i < fit.points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double apart2 = (fit.points[i] - fit.points[j]).tail<2>().squaredNorm() / spacing2;
      if (apart2 > far_pair * far_pair) continue;
      const double difference = fit.radius * (fit.left[i] - fit.left[j]);
      (apart2 < near_pair * near_pair ? squares.near : squares.far)
          .push_back(difference * difference / 2);
    }
  return squares;
}

// Detail that no quadric follows differs ever less between points that are ever nearer; scatter
// does not. Squares go as sigma^2 + c distance^2; pairs are even in distance^2, so that the near
// ones have a mean of near^2 / 2, the far ones of (near^2 + far^2) / 2.
double sigma_at_no_distance(const PairSquares& squares) {
  constexpr double chi_square_median = 0.4549;
  constexpr double at_near = near_pair * near_pair / 2,
                   at_far = (near_pair * near_pair + far_pair * far_pair) / 2;
  const double near = median(squares.near), far = median(squares.far);
  const double none = near - (far - near) * at_near / (at_far - at_near);
  return std::sqrt(std::max(0.0, none) / chi_square_median);
}

}  // namespace

double estimate_sigma(std::span<const Eigen::Vector3d> points) {
  const KdTree tree(points);
  const std::size_t step = std::max<std::size_t>(1, points.size() / wanted_fits);
  const std::size_t fits = (points.size() + step - 1) / step;
  std::vector<double> sigmas(fits);
  std::vector<PairSquares> squares(fits);
  parallel_for(
      fits,
      [&](std::size_t i) {
        std::vector<Neighbour> found;
        for (std::size_t k = least_neighbours;; k *= 2) {
          const std::size_t count = std::min(k, points.size());
          tree.k_nearest(points[i * step], count, found);
          const Fit fit = fit_quadric(points, found);
          sigmas[i] = fit.sigma;
          if (k == least_neighbours) squares[i] = pair_squares(fit);
          if (fit.radius >= radius_in_sigmas * fit.sigma || count == points.size() ||
              2 * k > most_neighbours)
            break;
          squares[i] = {};
        }
      },
      8);
  PairSquares all;
  for (const PairSquares& of_fit : squares) all.add(of_fit);
  const double sigma = median(sigmas);
  if (all.near.size() < least_pairs || all.near.size() > all.far.size()) return sigma;
  const double of_pairs = sigma_at_no_distance(all);
  return of_pairs < scatter_share * sigma ? of_pairs : sigma;
}

}  // namespace scan
