// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/gaussian_pair.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace scan::decoding {
namespace {

// Normal equations of (centre, amplitude) of the first and of the second.
struct PairEquations {
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
};

PairEquations linearise(const Samples& samples, const GaussianPair& pair) {
  PairEquations system;
  for (std::size_t i = 0; i < samples.signal_e.size(); ++i) {
    const double x = samples.first + static_cast<double>(i);
    const double u = (x - pair.first.centre) / pair.first.sigma;
    const double v = (x - pair.second.centre) / pair.second.sigma;
    const double bell_u = std::exp(-u * u / 2), bell_v = std::exp(-v * v / 2);
    const Eigen::Vector4d derivative(pair.first.amplitude * bell_u * u / pair.first.sigma, bell_u,
                                     pair.second.amplitude * bell_v * v / pair.second.sigma,
                                     bell_v);
    const double model = pair.first.amplitude * bell_u + pair.second.amplitude * bell_v;
    const double weight = 1 / (samples.background_variance_e2 + model);
    system.information += weight * derivative * derivative.transpose();
    system.gradient += weight * (samples.signal_e[i] - model) * derivative;
  }
  return system;
}

// At most half a width sideways and half an amplitude at a time.
double shrinking(const Eigen::Vector4d& change, const GaussianPair& pair) {
  return std::max({1.0, 2 * std::abs(change(0)) / pair.first.sigma,
                   2 * std::abs(change(2)) / pair.second.sigma,
                   -2 * change(1) / pair.first.amplitude, -2 * change(3) / pair.second.amplitude});
}

}  // namespace

std::optional<GaussianPair> fit_gaussian_pair(const Samples& samples, const GaussianPair& start) {
  GaussianPair pair = start;
  const double last = samples.first + static_cast<double>(samples.signal_e.size()) - 1;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const PairEquations system = linearise(samples, pair);
    Eigen::Vector4d change = system.information.ldlt().solve(system.gradient);
    if (!change.allFinite()) return std::nullopt;
    const double shrink = shrinking(change, pair);
    change /= shrink;
    pair.first.centre += change(0);
    pair.first.amplitude += change(1);
    pair.second.centre += change(2);
    pair.second.amplitude += change(3);
    if (!(pair.first.centre >= samples.first - 1 && pair.second.centre <= last + 1 &&
          pair.first.centre < pair.second.centre))
      return std::nullopt;
    const bool settled = shrink == 1 && std::abs(change(0)) < 1e-9 * pair.first.sigma &&
                         std::abs(change(2)) < 1e-6 * pair.second.sigma;
    if (!settled) continue;
    const Eigen::Matrix4d information = linearise(samples, pair).information;
    pair.first_sigma = std::sqrt(information.ldlt().solve(Eigen::Vector4d::Unit(0))(0));
    if (!std::isfinite(pair.first_sigma)) return std::nullopt;
    return pair;
  }
  return std::nullopt;
}

}  // namespace scan::decoding
