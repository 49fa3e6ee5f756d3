// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A phase camera's indirect light where neighbouring pixels share their paths.
//
// Over a matt surface indirect light varies slowly. So the paths of all pixels of a patch are one
// low-discrepancy sequence, its pixels taken in Morton's order, and each of four streams gives a
// least-squares fit (patch_fit.h) of the light's constant part and, for each tone, of its phasor
// without the way from surface to lens. Fits average paths as irradiance caches do (Ward et al.
// 1988), but from everywhere and with their error known: the streams' spread is that of chance,
// what the highest degree adds tells what the fit misses, and so do residuals beyond chance. The
// degree is the one with the least of both together; paths are doubled until that meets the goal of
// estimate_taps. Where even the highest degree is too stiff the patch is quartered, down to 8 x 8
// pixels; where it still is, as close to an edge where walls meet, pixels take paths of their own.
// The error is common to neighbours: means over a patch keep it.
#pragma once

#include "synth/scanners/phase_misfit.h"

namespace scan::synth {

// Addresses the chance of a pixel, and through its first pixel that of a patch.
using RayOf = std::function<std::uint64_t(const PixelPlace&)>;

// A pixel whose light is complete, and its taps' error as estimate_taps gives it.
struct SharedPixel {
  PixelPlace place;
  Estimate taps;
};

// Adds indirect light to the direct light of the patch's pixels. Left out are parts that no fit
// follows and those of fewer than 9 pixels, for which paths of their own are as well.
std::vector<SharedPixel> add_shared_light(const PathView& view, std::span<const Tone> tones,
                                          const Patch& patch, const RayOf& ray,
                                          const LightOf& light_of);

}  // namespace scan::synth
