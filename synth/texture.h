// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Textures: factors on the albedo of an object's surface.
#pragma once

#include "synth/scene.h"

namespace scan::synth {

// Throws scan::Error (input); `place` begins the message.
void check(const Texture& texture, const std::string& place);

// Where a texture is looked up: in the object's frame, and on the picture of a MeshTexture.
struct TexturePoint {
  Eigen::Vector3d x_in_object;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
};

// The place is that of the point of a triangle of the object's mesh; (0, 0) without a picture.
TexturePoint texture_point(const Object& object, std::uint32_t triangle,
                           const Eigen::Vector3d& x_in_object);

// The factor on the albedo, in [0, 1].
double texture_factor(const Texture& texture, const TexturePoint& at);

// Value noise in [0, 1]: a pseudo-random value at each point of the integer lattice (Philox of its
// coordinates), between them Perlin's quintic blend (2002), so it is twice differentiable.
double value_noise(const Eigen::Vector3d& x);

}  // namespace scan::synth
