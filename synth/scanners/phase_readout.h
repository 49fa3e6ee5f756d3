// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// From a phase camera's light to the readings of its taps.
#pragma once

#include "synth/scanners/phase_paths.h"

namespace scan::synth {

// One exposure of a scan; `frames` takes its taps.
struct Readout {
  const PhaseCamera& scanner;
  const RayCaster& caster;
  Pose world_from_scanner;  // at the exposure
  Exposure exposure;
  std::size_t index = 0;  // of the exposure: each has chance of its own
  RenderAddress address;
  DetectorEffects reading;
  PhaseTaps& frames;
};

// How far the taps that were estimated by paths are from their means, over their noise.
struct SamplingError {
  std::uint64_t paths = 0;
  double squares = 0;
  double largest = 0;
  std::uint64_t taps = 0;

  void add(const Sensor& sensor, const Estimate& estimate);
  SamplingError& operator+=(const SamplingError& other);
  RenderStatistics statistics() const;
};

void read_direct_light(const Readout& readout);
// By light transport: all pixels, or those where interreflection may matter.
SamplingError read_by_paths(const Readout& readout, const LightTransport& transport, PathNeed need);

}  // namespace scan::synth
