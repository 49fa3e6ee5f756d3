// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The same scanner with fewer rays, for pilots, costs and checks.
#pragma once

#include "synth/scanner.h"

namespace scan::synth {

// Rays that one scan decodes: pixels, pulses, or rows times steps of a laser line.
double ray_count(const Scanner& scanner);

// About `rays` of them over the same view, at least a few: a camera with larger pixels, a coarser
// raster, fewer steps of a sweep. Exposure, beam and noise of a reading stay as they are.
Scanner thinned(const Scanner& scanner, double rays);

}  // namespace scan::synth
