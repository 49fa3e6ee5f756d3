// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What fits of indirect light mean for a phase camera's taps, and how far they may be off.
#pragma once

#include "synth/scanners/patch_fit.h"
#include "synth/scanners/phase_patches.h"

namespace scan::synth {

// Light of a frame's pixels.
using LightOf = std::function<LightSum(const PixelPlace&)>;

// Signals are the light's constant part and, for each tone, real and imaginary part of its phasor
// without the way from surface to lens.
class PatchReadings {
 public:
  PatchReadings(const PathView& view, std::span<const Tone> tones, const LightOf& direct)
      : view_(view), tones_(tones), direct_(direct) {}

  std::size_t signals() const { return 1 + 2 * tones_.size(); }
  std::size_t tones() const { return tones_.size(); }
  // With the way from surface to lens.
  std::complex<double> phasor_of(const PatchPixel& pixel, const Eigen::VectorXd& signal,
                                 std::size_t tone) const;
  // The exposure's taps, then, of each frequency that has all four, the phasor's component across
  // the direct light's, scaled so that one goal serves for all.
  Eigen::ArrayXd readings(const PatchPixel& pixel, const Eigen::VectorXd& signal) const;
  Eigen::Index tap_count() const;
  // The square of the unit in which readings are judged, by a tap's mean.
  double unit_e2(double mean_e) const;
  LightSum direct(const PatchPixel& pixel) const { return direct_(pixel.place); }

 private:
  const PathView& view_;
  std::span<const Tone> tones_;
  const LightOf& direct_;
};

// Mean squares over a patch's pixels, in the readings' unit, one for each reading.
struct Misfit {
  Eigen::ArrayXd chance;       // variance of the fit by chance
  Eigen::ArrayXd last;         // square of what the fit's highest degree adds, free of chance
  Eigen::ArrayXd last_chance;  // its own variance
  double structure = 0;        // of residuals that no degree follows

  // What the fit misses, as far as it is known.
  Eigen::ArrayXd missed() const { return structure + last.max(0); }
  double square() const { return (chance + missed()).maxCoeff(); }
  // Whether more paths make it hardly better: what is missed is beyond chance and half of the goal.
  bool is_stiff(double goal) const;
};
// Of fits up to degree 1, 2, ...
std::vector<Misfit> misfits_of(const PatchReadings& readings, std::span<const PatchPixel> pixels,
                               const PatchFit& fit);

// Square of a pixel's readings' error: what chance makes of the streams' mean, and what the fit
// misses.
Eigen::ArrayXd error_e2(const Spread& streams, const Misfit& misfit, double unit_e2);

// Mean over the pixels by their direct light, which is most of it.
double mean_unit_e2(const PatchReadings& readings, std::span<const PatchPixel> pixels);

}  // namespace scan::synth
