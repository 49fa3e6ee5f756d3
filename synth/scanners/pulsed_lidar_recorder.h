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

  // All samples, DN, of pulse i into windows[i].
  void read(std::span<const Pulse> pulses, std::span<std::uint16_t* const> windows);

  std::size_t samples() const { return samples_; }                 // of a window
  const LidarPaths::Quality& quality() const { return quality_; }  // over all rays so far

 private:
  // Samples of a ray with light, from `start` on in expected_e_.
  struct Lit {
    SampleRange range;
    std::size_t start = 0;
  };

  // Of a ray with nothing but one echo from a point, and of any.
  void add_lone(const Pulse& pulse, const Echo& echo);
  void add_light(const Pulse& pulse, std::span<Echo> echoes);
  // Adds the fog's light to signal_e_ and dims the echoes behind it.
  SampleRange veil(const Pulse& pulse, std::span<Echo> echoes);
  // The ambient light of a range in expected_e_, in whole blocks of normal numbers.
  double* open(std::size_t ray, const SampleRange& range);
  void detect();
  void read_dark(std::span<const Pulse> pulses, std::span<std::uint16_t* const> windows);

  const LidarScan& scan_;
  const std::size_t samples_;
  PulseEchoes echoes_;
  std::vector<Lit> lit_;  // by ray
  // Of the lit samples of all rays, each ray's from a whole block on; the first `used_` count.
  std::size_t used_ = 0;
  std::vector<BlockAddress> blocks_;  // one for four
  std::vector<double> expected_e_;
  std::vector<float> normals_;
  std::vector<std::uint16_t> detected_;
  std::vector<BlockAddress> dark_blocks_;
  std::vector<std::uint32_t> words_;
  std::vector<double> signal_e_;  // of one ray, above the ambient light
  std::vector<Echo> arrivals_;
  std::vector<DelayedPulse> walk_;
  LidarPaths::Memory memory_;
  LidarPaths::Quality quality_;
};

}  // namespace scan::synth
