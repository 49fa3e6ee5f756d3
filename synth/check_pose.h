// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Poses in descriptions of scenes must be rigid motions.
#pragma once

#include <string>

#include "libscan/core/pose.h"

namespace scan::synth {

// Throws scan::Error (input) for a pose that is not finite, mirrors, or stretches by more than
// 1e-9; `field` begins the message.
void check_pose(const Pose& pose, const std::string& field);

}  // namespace scan::synth
