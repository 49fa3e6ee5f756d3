// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Into which directions a medium scatters.
#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>

namespace scan::synth {

struct HenyeyGreenstein {
  double mean_cosine = 0;  // g, -1 < g < 1; 0 is isotropic
};
struct Rayleigh {};
using PhaseFunction = std::variant<HenyeyGreenstein, Rayleigh>;

void check(const PhaseFunction& phase, const std::string& place);  // throws scan::Error (input)

// Per sr, integral over the sphere 1; the cosine is of the angle between the directions of travel
// before and after (1 forwards).
double phase_value(const PhaseFunction& phase, double cosine);
double mean_cosine(const PhaseFunction& phase);

// A direction of travel after scattering with density phase_value; `travel` unit.
Eigen::Vector3d sample_phase(const PhaseFunction& phase, const Eigen::Vector3d& travel,
                             const Eigen::Vector2d& u);

}  // namespace scan::synth
