// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which scan of which run is rendered: the address of its random numbers.
#pragma once

#include <cstdint>

namespace scan::synth {

struct RenderAddress {
  std::uint64_t seed = 1;
  std::uint32_t scan = 0;
};

}  // namespace scan::synth
