// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A scene of one clay ball, and what check() says of a scene.
#pragma once

#include <string>

#include "libscan/core/error.h"
#include "synth/scene.h"

namespace scan::synth {

inline Scene one_object(Texture texture = PlainTexture{}) {
  Scene scene;
  scene.materials.push_back({.name = "clay", .bsdf = Lambert{0.6}, .texture = texture});
  scene.objects.push_back({"ball", Pose::Identity(), Shape{SphereShape{0.1}}, 0});
  return scene;
}

inline std::string complaint_of(const Scene& scene) {
  try {
    check(scene);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace scan::synth
