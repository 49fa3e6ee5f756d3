// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The light that comes along a phase camera's views.
#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "synth/scanners/phase_views.h"

namespace scan::synth {

// One cosine of the correlation: light with a path of L metres brings electrons times
// contrast exp(i rad_per_m L) to its phasor.
struct Tone {
  double rad_per_m = 0;
  double contrast = 0;
  int frequency = 0;
  int harmonic = 1;
};
// All harmonics of all frequencies, in the order of PixelPhasors.
std::vector<Tone> tones_of(const PhaseCamera& scanner);

// Re(amplitude exp(i n k pi/2)) of harmonic n at tap k, without the rounding of the angle: it is 0,
// 90, 180 or 270 degrees.
inline double modulation(const std::complex<double>& amplitude, int harmonic, int tap) {
  const double values[] = {amplitude.real(), -amplitude.imag(), -amplitude.real(),
                           amplitude.imag()};
  return values[harmonic * tap % 4];
}

// Light of one pixel, to be added up.
struct LightSum {
  double& constant_e;
  std::span<std::complex<double>> amplitude_e;  // one per tone
};

// What does not change from view to view.
struct DirectLight {
  const PhaseCamera& scanner;
  const Scene& scene;
  std::span<const Tone> tones;
  Eigen::Matrix3d scanner_from_world;
  double weight = 1;  // of a view

  // Adds the light of view i of a batch that was traced.
  void add(const ViewBatch& batch, std::size_t i, const LightSum& sum) const;
  // Of all views, to the sums of their owners: sum_of(owner) is a LightSum.
  template <class SumOf>
  void add(const ViewBatch& batch, SumOf&& sum_of) const {
    BatchLight light;
    find(batch, 0, batch.size(), light);
    for (std::size_t i = 0; i < batch.size(); ++i)
      sum_of(batch.owner(i)).constant_e += light.constant_e[i];
    for (std::size_t t = 0; t < tones.size(); ++t) {
      turn(tones[t], batch.size(), light);
      for (std::size_t i = 0; i < batch.size(); ++i)
        sum_of(batch.owner(i)).amplitude_e[t] +=
            std::complex(light.real_e[i], light.imaginary_e[i]);
    }
  }

 private:
  using Column = std::array<double, ViewBatch::most>;
  struct BatchLight {
    Column constant_e;  // with ambient light
    Column own_e;       // the device's alone
    Column path_m;
    Column real_e, imaginary_e;  // of one tone
  };
  // Of views [begin, end): all but the phasors, which `turn` finds.
  void find(const ViewBatch& batch, std::size_t begin, std::size_t end, BatchLight& light) const;
  void turn(const Tone& tone, std::size_t count, BatchLight& light) const;
};

}  // namespace scan::synth
