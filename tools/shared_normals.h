// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Chance as a scan states it: shared by the rays that share noise.
#pragma once

#include <array>
#include <vector>

#include "libscan/core/random.h"
#include "libscan/core/scan.h"

namespace scan {

constexpr std::size_t artefact_draws = 7;

// Where a scan's random numbers come from.
struct NoiseAddress {
  std::uint64_t seed = 0;
  std::uint32_t scan = 0;
};

// For each ray of the scan's grid several standard normal numbers, those of one draw correlated as
// its noise_window says. Of a scan whose rays have noise of their own, or no grid, for each ray up
// to the last one that has a point.
std::vector<std::array<double, artefact_draws>> shared_normals(const Scan& scan,
                                                               const NoiseAddress& address);

}  // namespace scan
