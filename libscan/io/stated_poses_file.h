// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The poses' covariances in an alignment.json.
#pragma once

#include <filesystem>

#include "libscan/core/stated_poses.h"

namespace scan {

// scan::Error (input) for a file that is not there or is no alignment (json_output.h).
StatedPoses read_stated_poses(const std::filesystem::path& alignment);

}  // namespace scan
