// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/rendering.h"

#include <algorithm>
#include <cmath>

namespace scan::synth {

RenderStatistics statistics_of(std::span<const ReadingError> readings) {
  RenderStatistics statistics;
  double squares = 0;
  std::size_t lit = 0;
  for (const ReadingError& reading : readings) {
    statistics.paths += static_cast<std::uint64_t>(reading.paths);
    if (!(reading.share > 0)) continue;
    ++lit;
    squares += reading.share * reading.share;
    statistics.sampling_error_max = std::max(statistics.sampling_error_max, reading.share);
  }
  if (lit > 0) statistics.sampling_error_rms = std::sqrt(squares / static_cast<double>(lit));
  return statistics;
}

}  // namespace scan::synth
