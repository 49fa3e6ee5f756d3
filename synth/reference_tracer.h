// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The ray caster's oracle: slow, in double precision throughout, without Embree.
#pragma once

#include <memory>

#include "synth/ray_caster.h"

namespace scan::synth {

// An octree that is walked without haste: every triangle near the ray is tested, all hits are
// collected and sorted. RayCaster gives the same answers to the bit.
class ReferenceTracer {
 public:
  // Checks the scene first: throws scan::Error (input).
  explicit ReferenceTracer(const Scene& scene);
  ~ReferenceTracer();

  // As RayCaster::closest.
  std::optional<Hit> closest(const Ray& ray) const;

  // As RayCaster::blocked, but up to the very end.
  bool blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

 private:
  struct World;
  std::unique_ptr<const World> world_;
};

}  // namespace scan::synth
