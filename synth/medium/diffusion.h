// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Light that comes back out of a translucent body, in closed form: how much, from where, how late.
//
// The body fills a half-space under a smooth boundary with `index` (at least 1) and is homogeneous;
// a density grid counts with density 1. Scattering with mean cosine g stands for isotropic
// scattering with the reduced coefficient (1 - g) scattering_per_m (similarity): exact for g = 0,
// good where light is scattered often. What the surface itself reflects is not counted.
#pragma once

#include "synth/medium/medium.h"

namespace scan::synth {

// Chandrasekhar's H function of isotropic scattering (Radiative Transfer 1960, ch. V), by its
// explicit integral; single-scattering albedo and cosine from 0 to 1.
double chandrasekhar_h(double single_scattering_albedo, double cosine);

// Of light that falls on it evenly from all sides (Lambert), the share that comes back out from
// inside: Chandrasekhar's reflection function under a Fresnel boundary, both solved exactly.
double diffuse_albedo(const Medium& medium, double index);

// Mean optical length inside the body of the light that comes back, in metres: what a time of
// flight is late by, both ways together. Infinite for a body that does not absorb (the mean of a
// half-space is; a real body's own size limits it), 0 for one that does not scatter.
double penetration_path_m(const Medium& medium, double index);

// Of a narrow beam that enters at right angles: a source at depth_m below the surface and its
// negative image at image_m above it (Jensen et al. 2001; Farrell, Patterson, Wilson 1992).
// Describes light that was scattered often: reduced albedo near 1, radius above 1 / extinction.
struct Dipole {
  double depth_m = 0;
  double image_m = 0;
  double attenuation_per_m = 0;  // effective: sqrt(3 absorption extinction)
  double albedo = 0;             // reduced scattering over reduced extinction
};
Dipole dipole(const Medium& medium, double index);

// Light leaving per area at a distance from the beam, over the light that entered, 1/m^2.
double radial_exitance_per_m2(const Dipole& dipole, double radius_m);
// Its integral over the surface, and over the part of it beyond a radius.
double diffuse_reflectance(const Dipole& dipole);
double reflectance_beyond(const Dipole& dipole, double radius_m);

// Root mean square distance from the beam of the light that comes back: what widens a laser line
// and shifts it on a tilted surface. By the dipole: within 6 % from a reduced albedo of 0.99 and 25
// % from 0.9, too large below. Infinite for a body that does not absorb.
double lateral_spread_m(const Medium& medium, double index);

}  // namespace scan::synth
