// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/phase_function.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "libscan/core/error.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

// 1 - cosine and 1 + cosine, each to full relative precision, so that narrow lobes keep their
// shape.
struct Cosine {
  double from_one = 0;        // 1 - c
  double from_minus_one = 0;  // 1 + c
};

// Henyey and Greenstein 1941: p = (1 - g^2) / (4 pi (1 + g^2 - 2 g c)^(3/2)). With a = |g| and the
// cosine taken about the lobe's axis, 1 + a^2 - 2 a c = (1 - a)^2 + 2 a (1 - c) does not cancel.
double value(const HenyeyGreenstein& phase, double cosine) {
  const double a = std::abs(phase.mean_cosine);
  const double from_axis = std::max(0.0, phase.mean_cosine < 0 ? 1 + cosine : 1 - cosine);
  const double square = (1 - a) * (1 - a) + 2 * a * from_axis;
  return (1 - a) * (1 + a) / (4 * pi * square * std::sqrt(square));
}

double value(const Rayleigh&, double cosine) {
  return 3 / (16 * pi) * (1 + cosine * cosine);
}

// The inverse of the distribution function, c = (1 + a^2 - s^2) / (2 a) with s = (1 - a^2) / (1 - a
// + 2 a u), as differences from 1 and -1, factored: neither a = 0 nor a near 1 loses digits.
Cosine inverse(const HenyeyGreenstein& phase, double u) {
  const double a = std::abs(phase.mean_cosine);
  const double root = 1 - a + 2 * a * u;
  const double ahead = 2 * (1 - u) * (1 + a * u) * std::pow((1 - a) / root, 2);
  const double behind = u > 0 ? 2 * u * (1 - a + a * u) * std::pow((1 + a) / root, 2) : 0;
  return phase.mean_cosine < 0 ? Cosine{behind, ahead} : Cosine{ahead, behind};
}

// c^3 + 3 c = 8 u - 4 has the real root 2 sinh(asinh(4 u - 2) / 3).
Cosine inverse(const Rayleigh&, double u) {
  const double cosine = 2 * std::sinh(std::asinh(4 * u - 2) / 3);
  return {1 - cosine, 1 + cosine};
}

}  // namespace

void check(const PhaseFunction& phase, const std::string& place) {
  const auto* lobe = std::get_if<HenyeyGreenstein>(&phase);
  if (!lobe || std::abs(lobe->mean_cosine) < 1) return;
  std::ostringstream message;
  message.precision(17);
  message << place << "/mean_cosine: " << lobe->mean_cosine << ", must be between -1 and 1";
  throw Error(Trouble::input, message.str());
}

double phase_value(const PhaseFunction& phase, double cosine) {
  return std::visit([&](const auto& p) { return value(p, cosine); }, phase);
}

double mean_cosine(const PhaseFunction& phase) {
  const auto* lobe = std::get_if<HenyeyGreenstein>(&phase);
  return lobe ? lobe->mean_cosine : 0;
}

Eigen::Vector3d sample_phase(const PhaseFunction& phase, const Eigen::Vector3d& travel,
                             const Eigen::Vector2d& u) {
  const Cosine c = std::visit([&](const auto& p) { return inverse(p, u.x()); }, phase);
  const double sine = std::sqrt(std::max(0.0, c.from_one * c.from_minus_one));
  const double azimuth = 2 * pi * u.y();
  const Eigen::Vector3d across = travel.unitOrthogonal();
  return (travel * (c.from_minus_one - 1) +
          sine * (std::cos(azimuth) * across + std::sin(azimuth) * travel.cross(across)))
      .normalized();
}

}  // namespace scan::synth
