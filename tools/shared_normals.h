// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Chance as a scan states it: shared by the rays that share noise.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libscan/core/scan.h"

namespace scan {

// Which rays of a scan share noise, and the scan's number, by which its random numbers are
// addressed.
struct RayNoise {
  std::uint32_t scan = 0;
  RayGrid grid;
  RayGrid window{1, 1};  // see Scan::noise_window
};

// A standard normal number for each of the rays, correlated as the window says; independent for
// another seed, scan or draw.
std::vector<double> shared_normals(const RayNoise& noise, std::span<const std::uint32_t> rays,
                                   std::uint64_t seed, std::uint32_t draw);

}  // namespace scan
