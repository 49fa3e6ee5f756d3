// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Participating media: how far light travels and how it is scattered on the way.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>

#include "synth/medium/density_grid.h"
#include "synth/medium/phase_function.h"
#include "synth/sampling/sequence.h"

namespace scan::synth {

struct Homogeneous {};

// Coefficients at density 1.
struct Medium {
  double absorption_per_m = 0;
  double scattering_per_m = 0;
  PhaseFunction phase;
  std::variant<Homogeneous, DensityGrid> density;
};

double extinction_per_m(const Medium& medium);  // at density 1

void check(const Medium& medium, const std::string& place);  // throws scan::Error (input)

// Fog by its meteorological optical range: extinction ln(20) / MOR (WMO, 5 % contrast).
Medium fog(double optical_range_m, double mean_cosine, double single_scattering_albedo);
// Haze or fog by its visibility (2 % contrast at 550 nm) for light of another wavelength, after
// Kim et al. 2001; see synth/medium/visibility.h.
Medium haze(double visibility_m, double wavelength_m, double mean_cosine,
            double single_scattering_albedo);

// Share of light that gets from a to b: closed form for a homogeneous medium, else an unbiased
// estimate by ratio tracking (Novak et al. 2014).
double transmittance(const Medium& medium, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                     SampleSequence& random);

// Where light on the way from a along the unit direction is scattered next, if before `end_m`, by
// delta tracking (Woodcock 1965); `weight` is the albedo there (absorption by weight, not by
// chance), or 1 if the light arrives at the end. A medium that does not scatter lets all light
// arrive, with its transmittance as weight. `end_m` may be infinite.
struct Flight {
  std::optional<double> scattered_m;
  double weight = 1;
};
Flight sample_flight(const Medium& medium, const Eigen::Vector3d& a,
                     const Eigen::Vector3d& direction, double end_m, SampleSequence& random);

}  // namespace scan::synth
