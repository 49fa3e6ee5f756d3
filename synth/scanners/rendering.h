// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What every scanner's render() takes and gives besides the scene.
#pragma once

#include <cstdint>
#include <span>

#include "libscan/core/raw_frames.h"

namespace scan::synth {

// Which scan of which run is rendered: the address of its random numbers.
struct RenderAddress {
  std::uint64_t seed = 1;
  std::uint32_t scan = 0;
};

// What the simulation itself cost and how far it is from its own limit.
struct RenderStatistics {
  std::uint64_t paths = 0;  // of the light transport; 0 if direct light sufficed
  // Standard error of the readings' means by the finite number of paths, over the reading's own
  // noise: root mean square over all readings with light, and the largest.
  double sampling_error_rms = 0;
  double sampling_error_max = 0;
};

// Of one reading: how many paths it took, and the standard error that is left, over its noise.
struct ReadingError {
  int paths = 0;
  double share = 0;
};
// In the order given, so that the sum is the same for any number of threads.
RenderStatistics statistics_of(std::span<const ReadingError> readings);

struct Rendering {
  RawFrames frames;
  RenderStatistics statistics;
};

}  // namespace scan::synth
