// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Points of two scans whose descriptors are most alike: candidates, most of them wrong.
#pragma once

#include <cstdint>
#include <vector>

#include "libscan/align/features.h"

namespace scan {

struct DescriptorMatch {
  std::uint32_t source = 0, target = 0;
  float distance = 0;  // between the descriptors, in units of what the source's point has to others
};

// Pairs that are each among the other's nearest few, the most telling first, at most `most`. Exact:
// all distances are computed.
std::vector<DescriptorMatch> match_descriptors(const ScanFeatures& source,
                                               const ScanFeatures& target, std::size_t most);

}  // namespace scan
