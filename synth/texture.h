// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Textures: functions of the place in the object's frame.
#pragma once

#include "synth/scene.h"

namespace scan::synth {

// Throws scan::Error (input); `place` begins the message.
void check(const Texture& texture, const std::string& place);

// The factor on the albedo, in [0, 1].
double texture_factor(const Texture& texture, const Eigen::Vector3d& x_in_object);

// Value noise in [0, 1]: a pseudo-random value at each point of the integer lattice (Philox of its
// coordinates), between them Perlin's quintic blend (2002), so it is twice differentiable.
double value_noise(const Eigen::Vector3d& x);

}  // namespace scan::synth
