// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// From a beam to the readings of its waveform.
#pragma once

#include <optional>
#include <span>
#include <vector>

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
  ReadingTable dark;                // of samples without light of the pulse
  std::optional<LidarFog> fog;      // only if the effects call for it
  std::optional<LidarPaths> paths;  // as well
};
LidarScan prepare_scan(const LidarBeam& beam, const RenderAddress& address,
                       const EffectSet& effects);

// Records one ray after another, in storage that they share.
class LidarRecorder {
 public:
  explicit LidarRecorder(const LidarScan& scan);

  // All samples of the window, DN; valid until the next ray.
  std::span<const std::uint16_t> read(const Pose& world_from_scanner,
                                      const Eigen::Vector3d& direction, std::size_t ray);

  const LidarPaths::Quality& quality() const { return quality_; }  // over all rays so far

 private:
  // Fills signal_e_ and returns the range of samples with light.
  SampleRange light(const Pose& world_from_scanner, const Eigen::Vector3d& direction,
                    std::size_t ray);
  // Fills echoes_ and adds the fog's light.
  SampleRange straight_light(const Pose& world_from_scanner, const Eigen::Vector3d& direction);

  const LidarScan& scan_;
  std::vector<double> signal_e_;  // above the ambient light; all zero between rays
  std::vector<std::uint16_t> readings_;
  std::vector<Echo> echoes_, arrivals_;
  std::vector<DelayedPulse> walk_;
  LidarPaths::Memory memory_;
  LidarPaths::Quality quality_;
};

}  // namespace scan::synth
