// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Emitters, receivers and means with confidence intervals for the tests of light transport.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include "libscan/core/units.h"
#include "synth/sampling/warp.h"
#include "synth/transport/light_transport.h"

namespace scan::synth {

// The same intensity into all directions.
struct PointEmitter {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  double intensity = 1;

  Eigen::Vector3d position() const { return place; }
  double irradiance(const Eigen::Vector3d&, double length_m) const {
    return intensity / (length_m * length_m);
  }
  EmittedRay sample(const Eigen::Vector2d& u) const { return {place, to_sphere(u), flux()}; }
  double flux() const { return 4 * std::numbers::pi * intensity; }
};

// Intensity exp(-(tan^2 / 2 s^2)) / cos^3 about an axis, s the tangents' standard deviation: a
// Gaussian spot of the same shape on every plane across the axis.
struct BeamEmitter {
  Pose world_from_beam = Pose::Identity();  // shines along +z
  Eigen::Vector2d spread = {0.01, 0.01};    // of the tangents in x and y
  double peak = 1;                          // irradiance facing the beam on its axis at 1 m

  Eigen::Vector3d position() const { return world_from_beam.translation(); }
  double irradiance(const Eigen::Vector3d& direction, double length_m) const {
    const Eigen::Vector3d d = world_from_beam.linear().transpose() * direction;
    if (!(d.z() > 0)) return 0;
    const double x = d.x() / d.z() / spread.x(), y = d.y() / d.z() / spread.y();
    return peak * std::exp(-(x * x + y * y) / 2) / (d.z() * d.z() * d.z() * length_m * length_m);
  }
  // d(tan x) d(tan y) = d(solid angle) / cos^3, so the tangents are normal.
  EmittedRay sample(const Eigen::Vector2d& u) const {
    const double radius = std::sqrt(-2 * std::log1p(-u.x()));
    const double angle = 2 * std::numbers::pi * u.y();
    const Eigen::Vector3d d(spread.x() * radius * std::cos(angle),
                            spread.y() * radius * std::sin(angle), 1);
    return {position(), world_from_beam.linear() * d.normalized(), flux()};
  }
  double flux() const { return peak * 2 * std::numbers::pi * spread.x() * spread.y(); }
  // Where the ray crosses the plane of the beam's y and z, in which it is wide.
  Brightest brightest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    const Eigen::Vector3d normal = world_from_beam.linear().col(0);
    const double distance_m = normal.dot(position() - origin) / normal.dot(direction);
    const double range_m = (origin + distance_m * direction - position()).norm();
    return {distance_m, spread.x() * range_m / std::abs(normal.dot(direction))};
  }
};

// Sums per number of scatterings: electrons, electrons times path, a phasor.
struct Tally {
  double frequency_hz = 0;
  std::vector<double> electrons = std::vector<double>(8);
  std::vector<double> moment = std::vector<double>(8);
  std::vector<std::complex<double>> phasor = std::vector<std::complex<double>>(8);
  double device = 0, other = 0;
  double shortest_m = 1e300, longest_m = 0;

  void device_light(double e, double path_m, int scatterings) {
    device += e;
    shortest_m = std::min(shortest_m, path_m);
    longest_m = std::max(longest_m, path_m);
    if (scatterings >= 8) return;
    electrons[scatterings] += e;
    moment[scatterings] += e * path_m;
    phasor[scatterings] +=
        std::polar(e, 2 * std::numbers::pi * frequency_hz * path_m / speed_of_light_m_s);
  }
  void other_light(double e) { other += e; }
};

// A mean with the standard error that independent streams of paths show.
struct Mean {
  double value = 0;
  double error = 0;
};
inline constexpr int streams = 32;
// Student's t with 31 degrees of freedom exceeds 5.2 on either side with chance 1.2e-5: one test in
// a hundred thousand fails by bad luck, and seeds are fixed, so it fails never or always.
inline constexpr double sure = 5.2;

// Of `figures(tally, samples)`: for each stream the figures of one tally over `samples` paths,
// which `draw(random, tally)` traces.
template <class Draw, class Figures>
std::vector<Mean> means_of(int samples, const Tally& empty, const Draw& draw,
                           const Figures& figures, std::uint64_t address = 0) {
  std::vector<std::vector<double>> all;
  for (std::uint32_t stream = 0; stream < streams; ++stream) {
    Tally tally = empty;
    SampleSequence random(1, 0, address, stream);
    for (int i = 0; i < samples; ++i) {
      random.start(i);
      draw(random, tally);
    }
    all.push_back(figures(tally, samples));
  }
  std::vector<Mean> means(all[0].size());
  for (std::size_t k = 0; k < means.size(); ++k) {
    for (const auto& one : all) means[k].value += one[k] / streams;
    double scatter = 0;
    for (const auto& one : all) scatter += std::pow(one[k] - means[k].value, 2);
    means[k].error = std::sqrt(scatter / (streams * (streams - 1.0)));
  }
  return means;
}

// The truth lies in the confidence interval, and the interval is narrow enough to mean something:
// at most `resolution` of the truth.
inline void expect_mean(const Mean& mean, double truth, double resolution, const char* what) {
  EXPECT_LT(sure * mean.error, resolution * std::abs(truth)) << what << " is too uncertain";
  EXPECT_NEAR(mean.value, truth, sure * mean.error + 1e-9 * std::abs(truth)) << what;
}

// Two independent means of one number.
inline void expect_same(const Mean& a, const Mean& b, double resolution, const char* what) {
  const double error = std::hypot(a.error, b.error);
  EXPECT_LT(sure * error, resolution * std::abs(a.value)) << what << " is too uncertain";
  EXPECT_NEAR(a.value, b.value, sure * error + 1e-9 * std::abs(a.value)) << what;
}

// Nodes and weights of Gauss and Legendre's rule on [0, 1], by Newton's method on the polynomial.
struct Quadrature {
  std::vector<double> node, weight;
};
inline Quadrature gauss_legendre(int n) {
  Quadrature rule{std::vector<double>(n), std::vector<double>(n)};
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 100; ++step) {
      double p = 1, before = 0;
      for (int k = 1; k <= n; ++k)
        before = std::exchange(p, ((2 * k - 1) * x * p - (k - 1) * before) / k);
      slope = n * (x * p - before) / (x * x - 1);
      x -= p / slope;
    }
    rule.node[i] = (1 + x) / 2;
    rule.weight[i] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

}  // namespace scan::synth
