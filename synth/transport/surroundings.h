// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a path is in: air, fog, glass, a translucent body.
#pragma once

#include <array>
#include <vector>

#include "synth/scene.h"

namespace scan::synth {

// What light transport asks of an object again and again, found once.
struct ObjectOptics {
  Bsdf bsdf;  // without texture
  bool is_textured = false;
  bool is_smooth = false;        // a mirror or clear: all its light leaves in single directions
  bool has_delta = false;        // some of it does
  bool is_transmissive = false;  // then `index` and `interior` are those of its inside
  double index = 1;
  const Medium* interior = nullptr;  // of the scene; null: clear
};
// One per object; `scene` must outlive them.
std::vector<ObjectOptics> optics_of(const Scene& scene);

// The bodies around a point, the innermost last. Light goes into at most four at a time; more are
// taken for the fourth.
class Surroundings {
 public:
  double index() const { return depth_ > 0 ? bodies_[depth_ - 1]->index : 1; }
  // Null: vacuum or clear. `outside` is what the scene stands in.
  const Medium* medium(const Medium* outside) const {
    return depth_ > 0 ? bodies_[depth_ - 1]->interior : outside;
  }
  bool in_body() const { return depth_ > 0; }
  // The innermost; null in the open.
  const ObjectOptics* body() const { return depth_ > 0 ? bodies_[depth_ - 1] : nullptr; }
  // In a body that scatters.
  bool in_translucent_body() const {
    const Medium* inside = medium(nullptr);
    return inside && inside->scattering_per_m > 0;
  }
  void enter(const ObjectOptics& body);
  void exit(const ObjectOptics& body);  // nothing if it is not inside

 private:
  std::array<const ObjectOptics*, 4> bodies_{};
  int depth_ = 0;
};

}  // namespace scan::synth
