// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Readings of a phase camera's taps by the light on many pixels at once.
#pragma once

#include <functional>

#include "libscan/core/random_blocks.h"
#include "synth/block_detector.h"
#include "synth/scanners/phase_readout.h"

namespace scan::synth {

// What miscalibration adds to the distance of a pixel. The fixed pattern belongs to the device: it
// is the same for all scans.
double offset_m(const PhaseCamera& scanner, const RenderAddress& address, std::size_t pixel);

// Of the stream that a pixel's readings draw from.
std::uint64_t ray_address(const Readout& readout, std::size_t pixel);

// Each frequency takes one block of its pixel's stream. The readout outlives it.
class TapReader {
 public:
  TapReader(const Readout& readout, std::span<const Tone> tones);

  // light_of(k) is the light on pixels[k].
  void read(std::span<const std::size_t> pixels,
            const std::function<LightSum(std::size_t)>& light_of) const;

 private:
  struct Memory;

  bool all() const { return r_.exposure.frequency < 0; }
  std::size_t frequencies() const { return all() ? r_.frames.taps.size() : 1; }
  void expect(std::size_t pixel, const LightSum& light, std::span<double> expected_e) const;
  void detect(Memory& memory) const;
  void deliver(const Memory& memory, std::size_t k, std::size_t pixel) const;

  const Readout& r_;
  std::span<const Tone> tones_;
  BlockDetector detector_;
  std::vector<std::uint16_t*> taps_;  // that are exposed
};

}  // namespace scan::synth
