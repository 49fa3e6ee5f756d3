// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/gaussian_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace scan::decoding {
namespace {

constexpr double narrowest = 0.4, widest = 30;  // samples

// Weighted normal equations of (centre, amplitude, sigma) at `shape`.
struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

NormalEquations linearise(const Samples& samples, const Gaussian& shape) {
  NormalEquations system;
  for (std::size_t i = 0; i < samples.signal_e.size(); ++i) {
    const double u = (samples.first + static_cast<double>(i) - shape.centre) / shape.sigma;
    const double bell = std::exp(-u * u / 2);
    const double model = shape.amplitude * bell;
    const Eigen::Vector3d derivative(model * u / shape.sigma, bell, model * u * u / shape.sigma);
    const double weight = 1 / (samples.background_variance_e2 + model);
    system.information += weight * derivative * derivative.transpose();
    system.gradient += weight * (samples.signal_e[i] - model) * derivative;
  }
  return system;
}

// Scoring step; a known width is a huge weight on its old value.
Eigen::Vector3d step(NormalEquations system, Width width) {
  if (width == Width::known) {
    system.information.row(2).setZero();
    system.information.col(2).setZero();
    system.information(2, 2) = 1;
    system.gradient(2) = 0;
  }
  return system.information.ldlt().solve(system.gradient);
}

double centre_sigma(const Samples& samples, const Gaussian& shape, Width width) {
  Eigen::Matrix3d information = linearise(samples, shape).information;
  const int unknowns = width == Width::known ? 2 : 3;
  return std::sqrt(information.topLeftCorner(unknowns, unknowns)
                       .ldlt()
                       .solve(Eigen::VectorXd::Unit(unknowns, 0))(0));
}

}  // namespace

std::optional<Location> fit_gaussian(const Samples& samples, const Gaussian& start, Width width) {
  Gaussian shape = start;
  if (width == Width::free) shape.sigma = std::clamp(shape.sigma, narrowest, widest);
  const double last = samples.first + static_cast<double>(samples.signal_e.size()) - 1;
  for (int iteration = 0; iteration < 60; ++iteration) {
    if (!(shape.amplitude > 0)) return std::nullopt;
    Eigen::Vector3d change = step(linearise(samples, shape), width);
    if (!change.allFinite()) return std::nullopt;
    // At most one width sideways, half the amplitude and a third of the width at a time.
    const double shrink =
        std::max({1.0, std::abs(change(0)) / shape.sigma, -2 * change(1) / shape.amplitude,
                  3 * std::abs(change(2)) / shape.sigma});
    change /= shrink;
    const double old_sigma = shape.sigma;
    shape.centre += change(0);
    shape.amplitude += change(1);
    if (width == Width::free) shape.sigma = std::clamp(shape.sigma + change(2), narrowest, widest);
    if (!(shape.centre >= samples.first - 1 && shape.centre <= last + 1)) return std::nullopt;
    const bool settled = shrink == 1 && std::abs(change(0)) < 1e-9 * shape.sigma &&
                         std::abs(shape.sigma - old_sigma) < 1e-7 * shape.sigma;
    if (!settled) continue;
    const double sigma = centre_sigma(samples, shape, width);
    if (!std::isfinite(sigma)) return std::nullopt;
    return Location{shape, sigma};
  }
  return std::nullopt;
}

std::optional<Location> centroid(const Samples& samples, const Gaussian& start) {
  Location location{start, 0};
  const double reach = 3 * start.sigma + 1;  // a sample more: sampling is coarse for narrow peaks
  for (int iteration = 0; iteration < 20; ++iteration) {
    const double low = location.shape.centre - reach, high = location.shape.centre + reach;
    double mass = 0, moment = 0, spread = 0;
    for (std::size_t i = 0; i < samples.signal_e.size(); ++i) {
      const double x = samples.first + static_cast<double>(i);
      const double share = std::clamp(std::min(x + 0.5, high) - std::max(x - 0.5, low), 0.0, 1.0);
      const double offset = x - location.shape.centre;
      mass += share * samples.signal_e[i];
      moment += share * offset * samples.signal_e[i];
      spread += share * share * offset * offset *
                (samples.background_variance_e2 + std::max(samples.signal_e[i], 0.0));
    }
    const double shift = moment / mass;
    if (!(mass > 0) || !(std::abs(shift) < reach)) return std::nullopt;
    location.shape.centre += shift;
    location.centre_sigma = std::sqrt(spread) / mass;
    if (std::abs(shift) < 1e-9 * start.sigma) break;
  }
  return location;
}

}  // namespace scan::decoding
