// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Many scans made ready, thinned alike.
#pragma once

#include <span>
#include <vector>

#include "libscan/align/multiview.h"
#include "libscan/align/prepared_cloud.h"

namespace scan {

// The scans made ready, and how far residuals may be their own doing (see agreement.h).
struct PreparedScans {
  std::vector<PreparedCloud> clouds;
  std::vector<double> tolerance_m;
};

// Without the points whose sigma is more than twice their scan's median, and thinned by
// options.thin_m or, where that is 0, by twice the median of the scans' spacings.
PreparedScans prepare_scans(std::span<const PointCloud> clouds, const MultiviewOptions& options);

}  // namespace scan
