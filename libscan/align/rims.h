// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where a scan ends.
#pragma once

#include <vector>

#include "libscan/align/prepared_cloud.h"

namespace scan {

// Per point: whether its sixteen nearest lie on one side of it.
std::vector<bool> rim_points(const PreparedCloud& cloud);

}  // namespace scan
