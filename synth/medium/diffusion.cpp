// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/diffusion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "synth/bsdf/fresnel.h"
#include "synth/medium/quadrature.h"

namespace scan::synth {
namespace {

using std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

double reduced_scattering_per_m(const Medium& medium) {
  return (1 - mean_cosine(medium.phase)) * medium.scattering_per_m;
}

double reduced_extinction_per_m(const Medium& medium) {
  return reduced_scattering_per_m(medium) + medium.absorption_per_m;
}

// 1 - albedo theta cot(theta), of which 1 - theta cot(theta) = theta^2 / 3 + theta^4 / 45 + ...
// `absorbed` is 1 - albedo, which may be too small to tell the albedo from 1.
double dispersion(double absorbed, double theta) {
  const double square = theta * theta;
  const double rest =
      theta < 0.005 ? square * (1.0 / 3 + square / 45) : 1 - theta / std::tan(theta);
  return absorbed + (1 - absorbed) * rest;
}

// ln H(mu) = -mu / pi times the integral of ln(1 - albedo theta cot theta) / (cos^2 theta + mu^2
// sin^2 theta) from 0 to pi / 2 (Stibbs and Weir 1959).
double h_function(double absorbed, double cosine) {
  if (cosine == 0) return 1;
  const double integral = integrate_with_singular_ends(pi / 2, [&](double theta) {
    const double c = std::cos(theta), s = cosine * std::sin(theta);
    return std::log(dispersion(absorbed, theta)) / (c * c + s * s);
  });
  return std::exp(-cosine / pi * integral);
}

// A direction inside, under the boundary.
struct Stream {
  double cosine = 1;
  double weight = 0;     // of cosine d(cosine)
  double reflected = 0;  // back inside at the boundary
  double h = 1;
};

// Directions that can leave are spaced evenly in the cosine outside, the others up to the critical
// angle; both denser towards grazing, where H behaves as cosine ln(cosine).
std::vector<Stream> streams(double absorbed, double index) {
  std::vector<Stream> all;
  const double critical = std::sqrt((index - 1) * (index + 1)) / index;
  for (const QuadratureNode& node : gauss_legendre(20)) {
    const double t = node.x * node.x, dt = 2 * node.x * node.weight;
    const double inside = std::sqrt(critical * critical + t * t / (index * index));
    all.push_back({inside, t * dt / (index * index), fresnel_dielectric(t, index)});
    if (critical > 0) all.push_back({critical * t, critical * critical * t * dt, 1});
  }
  for (Stream& stream : all) stream.h = h_function(absorbed, stream.cosine);
  return all;
}

// Upward radiance just below the boundary by the downward one: (albedo / 2) H(mu) times the
// integral of H(mu') mu' / (mu + mu') (Chandrasekhar 1960, ch. III eq. 123 in azimuthal mean).
std::vector<double> scattered_back(double absorbed, const std::vector<Stream>& all,
                                   const std::vector<double>& downward) {
  std::vector<double> upward(all.size(), 0.0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < all.size(); ++j)
      upward[i] += all[j].weight * all[j].h * downward[j] / (all[i].cosine + all[j].cosine);
    upward[i] *= (1 - absorbed) / 2 * all[i].h;
  }
  return upward;
}

// Passes between boundary and body until no more light moves.
double half_space_albedo(double absorbed, double index) {
  const std::vector<Stream> all = streams(absorbed, index);
  std::vector<double> downward(all.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    downward[i] = (1 - all[i].reflected) * index * index / pi;  // irradiance 1 outside
  double albedo = 0;
  for (double left = 1; left > 1e-15 * albedo;) {
    const std::vector<double> upward = scattered_back(absorbed, all, downward);
    left = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      albedo += 2 * pi * all[i].weight * (1 - all[i].reflected) * upward[i];
      downward[i] = all[i].reflected * upward[i];
      left += 2 * pi * all[i].weight * downward[i];
    }
  }
  return albedo;
}

double image_decay(const Dipole& d, double height_m) {
  return std::exp(-d.attenuation_per_m * height_m);
}

}  // namespace

double chandrasekhar_h(double single_scattering_albedo, double cosine) {
  return h_function(1 - single_scattering_albedo, cosine);
}

double diffuse_albedo(const Medium& medium, double index) {
  if (medium.scattering_per_m == 0) return 0;
  const double absorbed = medium.absorption_per_m / reduced_extinction_per_m(medium);
  return std::min(1.0, half_space_albedo(absorbed, index));
}

// Each way of length l is weakened by exp(-absorption l), so its mean is -d ln(R) / d(absorption).
// R is smooth in s = sqrt(1 - albedo): d(s^2) / d(absorption) = albedo / extinction.
double penetration_path_m(const Medium& medium, double index) {
  if (medium.scattering_per_m == 0) return 0;
  if (medium.absorption_per_m == 0) return infinity;
  const double extinction = reduced_extinction_per_m(medium);
  // the limit of faint scattering is reached by then, and the difference not yet lost in rounding
  const double s = std::min(std::sqrt(medium.absorption_per_m / extinction), 1 - 1e-6);
  const double step = std::min({1e-3, s / 2, (1 - s) / 1000});
  const double high = half_space_albedo((s - step) * (s - step), index);
  const double low = half_space_albedo((s + step) * (s + step), index);
  const double per_s = std::log(high / low) / (2 * step);
  return index * per_s / (2 * s) * (1 - s * s) / extinction;
}

// Jensen et al. 2001, sec. 2.1; A by the boundary's mean reflectance from inside.
Dipole dipole(const Medium& medium, double index) {
  const double extinction = reduced_extinction_per_m(medium);
  const double inside = fresnel_dielectric_mean(1 / index);
  const double boundary = (1 + inside) / (1 - inside);
  return {.depth_m = 1 / extinction,
          .image_m = (1 + boundary * 4 / 3) / extinction,
          .attenuation_per_m = std::sqrt(3 * medium.absorption_per_m * extinction),
          .albedo = reduced_scattering_per_m(medium) / extinction};
}

double radial_exitance_per_m2(const Dipole& d, double radius_m) {
  const auto of = [&](double height_m) {
    const double distance = std::hypot(radius_m, height_m);
    return height_m * (1 + d.attenuation_per_m * distance) * image_decay(d, distance) /
           (distance * distance * distance);
  };
  return d.albedo / (4 * pi) * (of(d.depth_m) + of(d.image_m));  // eq. 4
}

double diffuse_reflectance(const Dipole& d) {
  return reflectance_beyond(d, 0);
}

// (1 + a d) exp(-a d) / d^2 is the derivative of -exp(-a d) / d.
double reflectance_beyond(const Dipole& d, double radius_m) {
  const auto of = [&](double height_m) {
    const double distance = std::hypot(radius_m, height_m);
    return height_m / distance * image_decay(d, distance);
  };
  return d.albedo / 2 * (of(d.depth_m) + of(d.image_m));
}

// Of each source, the integral of r^2 over the exitance is 2 z exp(-a z) / a times its share.
double lateral_spread_m(const Medium& medium, double index) {
  if (medium.scattering_per_m == 0) return 0;
  if (medium.absorption_per_m == 0) return infinity;
  const Dipole d = dipole(medium, index);
  const double near = image_decay(d, d.depth_m), far = image_decay(d, d.image_m);
  const double mean_depth_m = (d.depth_m * near + d.image_m * far) / (near + far);
  return std::sqrt(2 * mean_depth_m / d.attenuation_per_m);
}

}  // namespace scan::synth
