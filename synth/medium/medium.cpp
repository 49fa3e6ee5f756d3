// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/medium.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "libscan/core/error.h"
#include "synth/medium/visibility.h"

namespace scan::synth {
namespace {

// A distance with the density rate exp(-rate t); infinite for rate 0.
double exponential(double rate_per_m, double u) {
  return rate_per_m > 0 ? -std::log1p(-u) / rate_per_m : std::numeric_limits<double>::infinity();
}

void check_coefficient(const std::string& field, double per_m) {
  if (std::isfinite(per_m) && per_m >= 0) return;
  std::ostringstream message;
  message << field << ": " << per_m << ", must be finite and at least 0";
  throw Error(Trouble::input, message.str());
}

Medium with_extinction(double per_m, double mean_cosine, double single_scattering_albedo) {
  return {.absorption_per_m = (1 - single_scattering_albedo) * per_m,
          .scattering_per_m = single_scattering_albedo * per_m,
          .phase = HenyeyGreenstein{mean_cosine}};
}

// Calls body(t, density over majorant) at each tentative collision of a medium that is filled up to
// its majorants with fictitious matter (Woodcock 1965), until it returns false.
template <class Body>
void for_each_collision(const DensityGrid& grid, double extinction_per_m, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& direction, double end_m, SampleSequence& random,
                        Body&& body) {
  if (extinction_per_m == 0) return;
  BlockWalk walk(grid, a, direction, end_m);
  while (const auto segment = walk.next()) {
    const double rate = extinction_per_m * segment->majorant;
    if (rate == 0) continue;
    double t = segment->begin_m + exponential(rate, random.next());
    for (; t < segment->end_m; t += exponential(rate, random.next()))
      if (!body(t, density_at(grid, a + t * direction) / segment->majorant)) return;
  }
}

double transmittance_along(const Homogeneous&, const Medium& medium, const Eigen::Vector3d&,
                           const Eigen::Vector3d&, double end_m, SampleSequence&) {
  const double extinction = extinction_per_m(medium);
  return extinction > 0 ? std::exp(-extinction * end_m) : 1;
}

// Novak, Selle, Jarosz 2014: each tentative collision lets the fictitious share pass.
double transmittance_along(const DensityGrid& grid, const Medium& medium, const Eigen::Vector3d& a,
                           const Eigen::Vector3d& direction, double end_m, SampleSequence& random) {
  double share = 1;
  for_each_collision(grid, extinction_per_m(medium), a, direction, end_m, random,
                     [&](double, double density) {
                       share *= 1 - density;
                       return share > 0;
                     });
  return share;
}

std::optional<double> collision(const Homogeneous&, const Medium& medium, const Eigen::Vector3d&,
                                const Eigen::Vector3d&, double end_m, SampleSequence& random) {
  const double t = exponential(extinction_per_m(medium), random.next());
  return t < end_m ? std::optional(t) : std::nullopt;
}

std::optional<double> collision(const DensityGrid& grid, const Medium& medium,
                                const Eigen::Vector3d& a, const Eigen::Vector3d& direction,
                                double end_m, SampleSequence& random) {
  std::optional<double> found;
  for_each_collision(grid, extinction_per_m(medium), a, direction, end_m, random,
                     [&](double t, double density) {
                       if (random.next() < density) found = t;
                       return !found;
                     });
  return found;
}

}  // namespace

double extinction_per_m(const Medium& medium) {
  return medium.absorption_per_m + medium.scattering_per_m;
}

void check(const Medium& medium, const std::string& place) {
  check_coefficient(place + "/absorption_per_m", medium.absorption_per_m);
  check_coefficient(place + "/scattering_per_m", medium.scattering_per_m);
  check(medium.phase, place + "/phase");
  if (const auto* grid = std::get_if<DensityGrid>(&medium.density)) check(*grid, place);
}

Medium fog(double optical_range_m, double mean_cosine, double single_scattering_albedo) {
  return with_extinction(extinction_by_optical_range(optical_range_m), mean_cosine,
                         single_scattering_albedo);
}

Medium haze(double visibility_m, double wavelength_m, double mean_cosine,
            double single_scattering_albedo) {
  return with_extinction(extinction_by_kim(visibility_m, wavelength_m), mean_cosine,
                         single_scattering_albedo);
}

double transmittance(const Medium& medium, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                     SampleSequence& random) {
  const double end_m = (b - a).norm();
  const Eigen::Vector3d direction = (b - a).normalized();  // 0 if they are one point
  return std::visit(
      [&](const auto& density) {
        return transmittance_along(density, medium, a, direction, end_m, random);
      },
      medium.density);
}

Flight sample_flight(const Medium& medium, const Eigen::Vector3d& a,
                     const Eigen::Vector3d& direction, double end_m, SampleSequence& random) {
  return std::visit(
      [&](const auto& density) {
        if (medium.scattering_per_m == 0)
          return Flight{{}, transmittance_along(density, medium, a, direction, end_m, random)};
        const auto scattered_m = collision(density, medium, a, direction, end_m, random);
        const double albedo = medium.scattering_per_m / extinction_per_m(medium);
        return Flight{scattered_m, scattered_m ? albedo : 1};
      },
      medium.density);
}

}  // namespace scan::synth
