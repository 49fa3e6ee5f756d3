// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Limits of what multiview.h declares.
#include "libscan/align/multiview.h"
#include "libscan/core/error.h"

namespace scan {

void check(const MultiviewOptions& options) {
  check(options.icp);
  if (!(options.thin_m >= 0))
    throw Error(Trouble::usage,
                "align_scans: thin_m: " + std::to_string(options.thin_m) + ", must be at least 0");
  if (options.max_rounds < 1)
    throw Error(Trouble::usage, "align_scans: max_rounds: " + std::to_string(options.max_rounds) +
                                    ", must be at least 1");
  if (options.anchor < 0)
    throw Error(Trouble::usage,
                "align_scans: anchor: " + std::to_string(options.anchor) + ", must be at least 0");
}

}  // namespace scan
