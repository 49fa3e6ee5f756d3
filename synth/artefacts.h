// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Calibrated bodies at their places in a scanner's measuring volume.
//
// Sizes and places follow VDI/VDE 2634 part 2 (probing, sphere spacing, flatness) and common house
// tests (cylinder, step, waves); libscan/verify/artefacts.h and structural_resolution.h have the
// figures.
#pragma once

#include <vector>

#include "synth/scene.h"

namespace scan::synth {

// The volume is a box with the scanner's axes: x and y across, z along the line of sight. Bodies
// whose size is 0 get the usual share of its diagonal.
struct Artefacts {
  Eigen::Vector3d volume_m = Eigen::Vector3d::Zero();  // its edges
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  // in the world
  double ball_diameter_m = 0;                          // 0: 0.1 of the diagonal
  double bar_length_m = 0;                             // between the balls; 0: 0.35 of it
  double plate_m = 0;                                  // edge of the plate; 0: 0.5 of it
  double cylinder_diameter_m = 0;                      // 0: 0.1 of it; four times as long
  double step_m = 0;                                   // 0: 0.01 of it
};

// Throws scan::Error (input) naming field, value and limit: an edge that is not positive, a body
// that does not fit into the volume.
void check(const Artefacts& artefacts);

// With all sizes filled in.
Artefacts with_sizes(Artefacts artefacts);

// The objects of one place, of material 0, in the world. Shapes are placed so that what is measured
// faces the scanner.
using PlacedObjects = std::vector<Object>;

// A ball at ten places spread over the volume (Halton's points).
std::vector<PlacedObjects> ball_places(const Artefacts& sized, const Pose& world_from_scanner);
// Two balls in seven directions, none along the line of sight: the nearer would hide the farther.
std::vector<PlacedObjects> bar_places(const Artefacts& sized, const Pose& world_from_scanner);
// A plate (its face is z = 0 of the object) at three depths and tilted by 30 degrees four ways.
std::vector<PlacedObjects> plate_places(const Artefacts& sized, const Pose& world_from_scanner);
// A cylinder upright, lying, and between.
std::vector<PlacedObjects> cylinder_places(const Artefacts& sized, const Pose& world_from_scanner);
// The lower and the upper of two parallel faces side by side, turned four ways about the sight.
std::vector<PlacedObjects> step_places(const Artefacts& sized, const Pose& world_from_scanner);

// Waves of one period on a plate across the sight: z = amplitude cos(2 pi x / period) of the
// object, whose x axis is the scanner's, or its y axis if turned; a twentieth of the period in
// amplitude, so that no slope exceeds 17.4 degrees. As a mesh of 32 facets a period, which keep
// (sin(pi / 32) / (pi / 32))^2 = 0.997 of the amplitude.
enum class WaveAxis { x, y };
double wave_amplitude_m(double period_m);
PlacedObjects wave_plate(const Artefacts& sized, const Pose& world_from_scanner, double period_m,
                         WaveAxis axis);

}  // namespace scan::synth
