// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Scenes simple enough to be known without a look.
#pragma once

#include "synth/scene.h"

namespace scan::synth {

// Whether light of a device there (world frame) meets surfaces at most once: one convex opaque
// shape alone, seen from outside, in clear air and without lights. (A mesh is not examined.)
bool light_meets_once(const Scene& scene, const Eigen::Vector3d& device);

}  // namespace scan::synth
