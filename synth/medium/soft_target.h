// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a homogeneous medium such as fog sends back to a pulsed device: light scattered once, in
// closed form (Rasshofer et al. 2011; Hahner et al. 2021).
#pragma once

#include "synth/medium/medium.h"

namespace scan::synth {

// A device whose beam and line of sight are one, in a homogeneous medium. A white Lambert target
// that fills the beam and faces it at range R returns white_electrons_at_1m / R^2 in clear air.
struct SoftTarget {
  double white_electrons_at_1m = 1;
  double backscatter_per_m_sr = 0;  // beta: scattering times the phase function straight back
  double extinction_per_m = 0;
  double near_m = 0.5;  // the device sees nothing nearer; above 0
};
SoftTarget soft_target(const Medium& medium, double white_electrons_at_1m, double near_m);

// Of a pulse, Gaussian with that sigma, sent at time 0: electrons that the medium nearer than
// `far_m` (where a solid target stands; may be infinite) returns between two times. Each range
// interval dR returns pi beta exp(-2 extinction R) white_electrons_at_1m / R^2 dR at the time 2 R /
// c; relative error below 1e-9 of what the whole medium returns.
double soft_target_electrons(const SoftTarget& target, double far_m, double pulse_sigma_s,
                             double begin_s, double end_s);

// Without limits of time: all that the medium nearer than far_m returns.
double soft_target_total(const SoftTarget& target, double far_m);

}  // namespace scan::synth
