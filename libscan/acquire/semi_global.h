// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Semi-global matching (Hirschmueller 2008) by OpenCV.
#pragma once

#include <cstdint>

#include "libscan/core/image.h"

namespace scan::decoding {

struct SemiGlobalOptions {
  int min_disparity_px = 0;
  int disparities_px = 0;
  int block_px = 5;
  bool reject = true;  // matches that are not unique, and speckles
};

// Disparity of each left pixel to 1/16 px, NaN where there is none. Every left pixel is tried
// against the whole search range; where that leaves the right image its first column is repeated.
// One thread, so the same bytes always.
Image<float> semi_global(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                         const SemiGlobalOptions& options);

// The same for each pixel of the right image: the pair is mirrored, which swaps the roles.
Image<float> semi_global_of_right(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                                  const SemiGlobalOptions& options);

}  // namespace scan::decoding
