// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Light at a lidar's echo that is not the echo's own, by a few paths.
#pragma once

#include "synth/scanners/pulsed_lidar_paths.h"

namespace scan::synth {

// Means with three standard errors added: light that does not come straight back, and of the
// scene's lights.
struct EchoLight {
  double indirect_e = 0;
  double extra_e_m = 0;  // electrons times extra one-way length
  double late_e_m = 0;  // the same of what comes over two or more surfaces within the window of the
                        // direct echo's fit; later light is another echo
  double lamps_e = 0;   // per sample and electron of a white surface under 1 W/m^2
};

// Of a beam (unit direction, scanner frame) whose echo lies at that range and is fitted in a window
// of that half width. `index` tells the beams' paths apart.
EchoLight echo_light(const PulsedLidar& scanner, const LightTransport& transport,
                     const Pose& world_from_scanner, const Eigen::Vector3d& direction,
                     std::size_t index, double range_m, double half_window_m);

}  // namespace scan::synth
