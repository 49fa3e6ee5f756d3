// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Oren and Nayar 1994, "Generalization of Lambert's Reflectance Model", eqs. 27 to 29: direct light
// of V-grooves and light reflected once between their faces.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "synth/bsdf/directional_table.h"
#include "synth/bsdf/kinds.h"
#include "synth/sampling/warp.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

double square(double x) {
  return x * x;
}

// f = albedo * direct + albedo^2 * twice.
struct Terms {
  double direct, twice;
};

Terms terms(double slope_rad, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  const double sigma2 = square(slope_rad);
  const bool in_is_lower = in.z() < out.z();
  const Eigen::Vector3d& low = in_is_lower ? in : out;
  const Eigen::Vector3d& high = in_is_lower ? out : in;
  const double sine_low = std::hypot(low.x(), low.y());
  const double sine_high = std::hypot(high.x(), high.y());
  const double alpha = std::atan2(sine_low, low.z()), beta = std::atan2(sine_high, high.z());
  const double sines = sine_low * sine_high;
  const double turn =
      sines > 0 ? std::clamp((out.x() * in.x() + out.y() * in.y()) / sines, -1.0, 1.0) : 0;
  const double share = sigma2 / (sigma2 + 0.09);
  const double c1 = 1 - 0.5 * sigma2 / (sigma2 + 0.33);
  const double backward = turn >= 0 ? 0 : std::pow(2 * beta / pi, 3);
  const double c2 = 0.45 * share * (sine_low - backward);
  const double c3 = 0.125 * share * square(4 * alpha * beta / (pi * pi));
  // tan((a + b) / 2) = (sin a + sin b) / (cos a + cos b)
  const double half_sum = (sine_low + sine_high) / (low.z() + high.z());
  const double direct =
      c1 + turn * c2 * sine_high / high.z() + (1 - std::abs(turn)) * c3 * half_sum;
  const double twice = 0.17 * sigma2 / (sigma2 + 0.13) * (1 - turn * square(2 * beta / pi));
  // the fit falls a little below 0 where steep grooves hide most of the light
  return {std::max(direct, 0.0) / pi, twice / pi};
}

// Integral of a term times cosine over the hemisphere.
double hemisphere_share(double slope_rad, double cosine, double Terms::*term) {
  const Eigen::Vector3d out(std::sqrt(1 - cosine * cosine), 0, cosine);
  return integral_over_unit([&](double t) {
    // cosines t^2 lie densest at grazing angles, where the direct term rises; turns from 0 to pi in
    // two halves, since the terms have a kink at a right angle
    const double z = t * t, sine = std::sqrt(1 - z * z);
    const auto at = [&](double turn) {
      return terms(slope_rad, out, {sine * std::cos(turn), sine * std::sin(turn), z}).*term;
    };
    const double half =
        integral_over_unit([&](double s) { return at(s * pi / 2) + at(pi - s * pi / 2); });
    return 2 * half * pi / 2 * z * 2 * t;
  });
}

struct Shares {
  DirectionalTable direct, twice;
};

}  // namespace

double evaluate(const OrenNayar& bsdf, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  if (!is_above(out, in)) return 0;
  const Terms f = terms(bsdf.slope_rad, out, in);
  return bsdf.albedo * (f.direct + bsdf.albedo * f.twice);
}

double density(const OrenNayar&, const Eigen::Vector3d& out, const Eigen::Vector3d& in) {
  return is_above(out, in) ? cosine_hemisphere_density(in) : 0;
}

std::optional<BsdfSample> sample(const OrenNayar& bsdf, const Eigen::Vector3d& out,
                                 const Eigen::Vector3d& u) {
  const Eigen::Vector3d in = to_cosine_hemisphere(u.tail<2>());
  if (!is_above(out, in)) return std::nullopt;
  return BsdfSample{
      .in = in, .weight = pi * evaluate(bsdf, out, in), .density = cosine_hemisphere_density(in)};
}

double albedo(const OrenNayar& bsdf, const Eigen::Vector3d& in) {
  if (!is_above(in)) return 0;
  const Shares& shares = tabulated<OrenNayar, Shares>({bsdf.slope_rad}, [&] {
    const auto share = [&](double Terms::*term) {
      return DirectionalTable(
          [&](double cosine) { return hemisphere_share(bsdf.slope_rad, cosine, term); });
    };
    return Shares{share(&Terms::direct), share(&Terms::twice)};
  });
  return bsdf.albedo * (shares.direct(in.z()) + bsdf.albedo * shares.twice(in.z()));
}

}  // namespace scan::synth
