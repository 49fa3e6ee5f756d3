// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A device before a scene, and what its points say of themselves there.
#pragma once

#include <string>
#include <vector>

#include "libscan/acquire/acquire.h"
#include "libscan/verify/surface_error.h"
#include "synth/ray_caster.h"
#include "synth/scanner.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {

struct StatedScanner {
  std::string device;
  std::string target;
  double light = 1;  // of the electrons that the device collects as a rule
  Scanner scanner;
  Scene scene;
  AcquireOptions acquire = {};
};

// The figures of one noisy scan against its truth.
inline std::vector<Measurement> stated_figures(const StatedScanner& of, std::uint64_t seed) {
  const RayCaster caster(of.scene);
  const auto frames =
      render(of.scanner, caster, Pose::Identity(), {.seed = seed, .scan = 1}, sensor_effects)
          .frames;
  const Scan scan = acquire(frames, of.acquire);
  const ScanTruth truth{.name = of.device,
                        .world_from_scanner = Pose::Identity(),
                        .rays = true_rays(of.scanner, caster, Pose::Identity())};
  return range_error(scan.cloud, scan.ray, truth);
}

}  // namespace scan::synth
