// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_misfit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan::synth {
namespace {

// Of a tap's error, over that of a phasor's turn: see estimate_taps.
constexpr double brightness_slack = 2.5;

using Streams = std::array<Eigen::ArrayXd, patch_streams>;

// The streams' readings by some of the fit's functions alone.
Streams part_of(const PatchReadings& readings, const PatchPixel& pixel, const PatchFit& fit,
                Eigen::Index row, Eigen::Index begin, Eigen::Index end) {
  Streams part;
  for (int k = 0; k < patch_streams; ++k)
    part[k] = readings.readings(pixel, (fit.basis.functions.row(row).segment(begin, end - begin) *
                                        fit.coefficients[k].middleRows(begin, end - begin))
                                           .transpose());
  return part;
}

}  // namespace

std::complex<double> PatchReadings::phasor_of(const PatchPixel& pixel,
                                              const Eigen::VectorXd& signal,
                                              std::size_t tone) const {
  const auto at = static_cast<Eigen::Index>(2 * tone);
  return std::complex(signal[1 + at], signal[2 + at]) *
         std::polar(1.0, tones_[tone].rad_per_m * pixel.distance_m);
}

Eigen::Index PatchReadings::tap_count() const {
  const auto frequencies = static_cast<Eigen::Index>(view_.scanner.frequencies_hz.size());
  return view_.exposure.frequency < 0 ? 4 * frequencies : 1;
}

// The noise of a phasor's component is a tap's over sqrt(2).
Eigen::ArrayXd PatchReadings::readings(const PatchPixel& pixel,
                                       const Eigen::VectorXd& signal) const {
  const Eigen::Index taps = tap_count();
  Eigen::ArrayXd reading = Eigen::ArrayXd::Constant(taps + taps / 4, signal[0]);
  const LightSum direct = direct_(pixel.place);
  for (std::size_t t = 0; t < tones_.size(); ++t) {
    const Tone& tone = tones_[t];
    const std::complex<double> phasor = phasor_of(pixel, signal, t);
    if (taps == 1) {
      reading[0] += modulation(phasor, tone.harmonic, view_.exposure.tap);
      continue;
    }
    for (int k = 0; k < 4; ++k)
      reading[4 * tone.frequency + k] += modulation(phasor, tone.harmonic, k);
    if (tone.harmonic != 1) continue;
    const std::complex<double> along = direct.amplitude_e[t];
    const double length = std::max(std::abs(along), 1e-300);
    reading[taps + tone.frequency] =
        brightness_slack * std::numbers::sqrt2 * (std::conj(along) * phasor).imag() / length;
  }
  return reading;
}

double PatchReadings::unit_e2(double mean_e) const {
  return brightness_slack * brightness_slack * tap_variance_e2(view_.scanner.sensor, mean_e);
}

bool Misfit::is_stiff(double goal) const {
  return structure > std::max(goal / 2, chance.maxCoeff()) ||
         (last > (4 * last_chance).max(chance).max(goal / 2)).any();
}

// Some of the pixels, spread over the patch, serve for all: an odd stride meets all columns.
std::vector<Misfit> misfits_of(const PatchReadings& readings, std::span<const PatchPixel> pixels,
                               const PatchFit& fit) {
  const std::size_t stride = (pixels.size() / 64) | 1;
  const double looks = std::ceil(static_cast<double>(pixels.size()) / static_cast<double>(stride));
  const std::vector<Eigen::Index>& count = fit.basis.count;
  std::vector<Misfit> misfits(count.size() - 1);
  for (std::size_t i = 0; i < pixels.size(); i += stride) {
    const auto row = static_cast<Eigen::Index>(i);
    Streams whole = part_of(readings, pixels[i], fit, row, 0, count[0]);
    const double mean_e =
        readings.direct(pixels[i]).constant_e + std::max(0.0, spread_of(whole).mean[0]);
    const double weight = 1 / (looks * readings.unit_e2(mean_e));
    for (std::size_t d = 0; d < misfits.size(); ++d) {
      const Streams last = part_of(readings, pixels[i], fit, row, count[d], count[d + 1]);
      for (int k = 0; k < patch_streams; ++k) whole[k] += last[k];
      const Spread all = spread_of(whole), added = spread_of(last);
      Misfit& misfit = misfits[d];
      if (i == 0)
        misfit.chance = misfit.last = misfit.last_chance = Eigen::ArrayXd::Zero(all.mean.size());
      misfit.chance += weight * all.variance;
      misfit.last += weight * (added.mean.square() - added.variance);
      misfit.last_chance += weight * added.variance;
    }
  }
  for (Misfit& misfit : misfits) misfit.structure = fit.structure / mean_unit_e2(readings, pixels);
  return misfits;
}

Eigen::ArrayXd error_e2(const Spread& streams, const Misfit& misfit, double unit_e2) {
  return streams.variance + unit_e2 * misfit.missed();
}

double mean_unit_e2(const PatchReadings& readings, std::span<const PatchPixel> pixels) {
  double sum_e2 = 0;
  for (const PatchPixel& pixel : pixels)
    sum_e2 += readings.unit_e2(readings.direct(pixel).constant_e);
  return sum_e2 / static_cast<double>(pixels.size());
}

}  // namespace scan::synth
