// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The scanners that synth can be: raw frames and truth from one place.
//
// To add one: 1. synth/scanners/<name>.h with its fields (units in names), check(), render() and
// true_rays(); 2. its name in the variant here; 3. its keys in tools/recipe; scanner_test.cpp walks
// the variant.
#pragma once

#include <cstdint>
#include <variant>

#include "libscan/core/progress.h"
#include "synth/scanners/laser_line.h"
#include "synth/scanners/phase_camera.h"
#include "synth/scanners/pulsed_lidar.h"
#include "synth/scanners/stereo_pair.h"

namespace scan::synth {

using Scanner = std::variant<LaserLine, StereoPair, PhaseCamera, PulsedLidar>;

// Of the device's own light.
double wavelength_m(const Scanner& scanner);

// Throws scan::Error (input) naming field, value and limit.
void check(const Scanner& scanner);

// The raw frames of one scan. Chance is addressed by (seed, scan, ray): the same bytes for any
// number of threads.
Rendering render(const Scanner& scanner, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects);

// Where the centre of each ray truly ends, indexed like the decoder's rays (see raw_frames.h).
std::vector<RayTruth> true_rays(const Scanner& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner);

}  // namespace scan::synth
