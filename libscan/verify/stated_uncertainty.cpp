// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Normalised squared errors of points, poses and surfaces.
#include "libscan/verify/stated_uncertainty.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "libscan/core/error.h"
#include "libscan/verify/chi_square.h"
#include "libscan/verify/statistics.h"

namespace scan {
namespace {

void check_degrees(int degrees) {
  if (degrees != 1 && degrees != 6)
    throw Error(Trouble::usage,
                "stated uncertainty: degrees is " + std::to_string(degrees) + ", must be 1 or 6");
}

// Where the root of the mean of so many independent squares over their degrees lies with 95 %.
Interval honest_root(std::size_t squares, int degrees) {
  const double all = static_cast<double>(squares) * degrees;
  return {std::sqrt(chi_square_quantile(0.025, all) / all),
          std::sqrt(chi_square_quantile(0.975, all) / all)};
}

}  // namespace

std::vector<Measurement> stated_uncertainty(const std::string& what, const NormalisedErrors& errors,
                                            const std::string& over) {
  check_degrees(errors.degrees);
  if (errors.squares.empty()) return {};
  const double limit = chi_square_quantile(0.95, errors.degrees);
  const auto inside = std::count_if(errors.squares.begin(), errors.squares.end(),
                                    [&](double square) { return square <= limit; });
  const auto figure = [&](const std::string& name, double value) {
    return Measurement{
        .name = name, .value = value, .unit = "1", .over = over, .count = errors.squares.size()};
  };
  auto root =
      figure("normalised_" + what + "_error_rms", std::sqrt(mean(errors.squares) / errors.degrees));
  root.expected = honest_root(errors.squares.size(), errors.degrees);
  return {root, figure(what + "_error_within_95",
                       static_cast<double>(inside) / static_cast<double>(errors.squares.size()))};
}

std::optional<double> normalised_square(const Eigen::Vector3d& error_m,
                                        const Eigen::Matrix3d& covariance_m2) {
  if (!covariance_m2.allFinite()) return std::nullopt;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(covariance_m2);
  const double variance_m2 = axes.eigenvalues()(2);
  if (!(variance_m2 > 0)) return std::nullopt;
  const double along_m = axes.eigenvectors().col(2).dot(error_m);
  return along_m * along_m / variance_m2;
}

NormalisedErrors normalised_pose_errors(std::span<const Pose> estimated,
                                        std::span<const Pose> truth,
                                        std::span<const std::optional<StatedPose>> stated,
                                        std::size_t anchor) {
  if (estimated.size() != truth.size() || stated.size() != truth.size() || anchor >= truth.size())
    throw Error(Trouble::input, "pose uncertainty: " + std::to_string(estimated.size()) +
                                    " estimated poses, " + std::to_string(truth.size()) +
                                    " true poses and " + std::to_string(stated.size()) +
                                    " covariances must be equally many, and the anchor, " +
                                    std::to_string(anchor) + ", one of them");
  NormalisedErrors errors{.squares = {}, .degrees = 6};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i == anchor || !stated[i]) continue;
    const Pose should = estimated[anchor] * truth[anchor].inverse() * truth[i];
    const Eigen::Translation3d centre(stated[i]->centre);
    const Vector6 twist = log(centre.inverse() * estimated[i] * should.inverse() * centre);
    errors.squares.push_back(twist.dot(stated[i]->covariance.ldlt().solve(twist)));
  }
  return errors;
}

NormalisedErrors normalised_deviations(std::span<const double> deviations_m,
                                       std::span<const double> standard_errors_m,
                                       std::span<const double> support_spacings,
                                       double most_spacings) {
  if (standard_errors_m.size() != deviations_m.size() ||
      support_spacings.size() != deviations_m.size())
    throw Error(Trouble::input,
                "surface uncertainty: " + std::to_string(deviations_m.size()) + " deviations, " +
                    std::to_string(standard_errors_m.size()) + " standard errors and " +
                    std::to_string(support_spacings.size()) + " distances to the data");
  NormalisedErrors errors;
  for (std::size_t i = 0; i < deviations_m.size(); ++i) {
    if (!(standard_errors_m[i] > 0 && std::isfinite(standard_errors_m[i])) ||
        !(support_spacings[i] <= most_spacings))
      continue;
    const double ratio = deviations_m[i] / standard_errors_m[i];
    errors.squares.push_back(ratio * ratio);
  }
  return errors;
}

}  // namespace scan
