// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// From beams to the readings of their waveforms.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "libscan/core/random_blocks.h"
#include "synth/block_detector.h"
#include "synth/reading_table.h"
#include "synth/scanners/pulsed_lidar_fog.h"
#include "synth/scanners/pulsed_lidar_paths.h"

namespace scan::synth {

// What a scan's rays have in common; `beam` must outlive it.
struct LidarScan {
  const LidarBeam& beam;
  SampleAxis axis;
  DetectorEffects reading;
  RenderAddress address;
  PulseTable pulse;                 // of echoes from a point
  BlockDetector detector;           // of samples with light of the pulse
  ReadingTable dark;                // of the others
  std::optional<LidarFog> fog;      // only if the effects call for it
  std::optional<LidarPaths> paths;  // as well
};
LidarScan prepare_scan(const LidarBeam& beam, const RenderAddress& address,
                       const EffectSet& effects);

// Records some neighbouring rays after others, in storage that they share.
class LidarRecorder {
 public:
  explicit LidarRecorder(const LidarScan& scan);

  // All samples of their windows, DN, pulse by pulse; valid until the next call.
  std::span<const std::uint16_t> read(std::span<const Pulse> pulses);

  std::size_t samples() const { return signal_e_.size(); }         // of the window
  const LidarPaths::Quality& quality() const { return quality_; }  // over all rays so far

 private:
  // Fills signal_e_ and returns the range of samples with light.
  SampleRange light(const Pulse& pulse, std::span<Echo> echoes);
  // Adds the fog's light and dims the echoes behind it.
  SampleRange veil(const Pulse& pulse, std::span<Echo> echoes);
  // From signal_e_ to the end of expected_e_, in whole blocks of normal numbers.
  void collect(std::size_t ray, const SampleRange& lit);
  void detect();
  void read_dark(std::span<const Pulse> pulses);

  const LidarScan& scan_;
  std::vector<double> signal_e_;  // of one ray, above the ambient light; all zero between rays
  PulseEchoes echoes_;
  // Of the lit samples of all rays, each ray's from a whole block on.
  std::vector<SampleRange> lit_;  // by ray
  std::vector<std::size_t> starts_;
  std::vector<BlockAddress> blocks_;
  std::vector<double> expected_e_, normals_;
  std::vector<std::uint16_t> detected_;
  std::vector<std::uint32_t> words_;
  std::vector<std::uint16_t> readings_;
  std::vector<Echo> arrivals_;
  std::vector<DelayedPulse> walk_;
  LidarPaths::Memory memory_;
  LidarPaths::Quality quality_;
};

}  // namespace scan::synth
