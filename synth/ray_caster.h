// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Rays against a scene: Embree finds the candidate, double precision decides where it is.
#pragma once

#include <memory>
#include <optional>

#include "synth/scene.h"

namespace scan::synth {

struct Hit {
  double distance_m = 0;  // along the unit direction
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  // geometric, unit, outward of the object
  int object = -1;
  std::uint32_t triangle = 0;  // of a mesh
};

// Built once per scene, used from many threads. Embree runs in ROBUST mode on floats relative to the
// scene's own origin; hits are computed again in double, so a scene far from the origin keeps its
// accuracy. Analytic shapes are user geometry: spheres and planes by closed form, others by stepping
// along their distance field.
class RayCaster {
 public:
  explicit RayCaster(const Scene& scene);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;

  // First hit with distance in (min_m, max_m); `direction` unit, world frame. Among hits at the same
  // distance the lowest object wins.
  std::optional<Hit> closest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double min_m = 0, double max_m = 1e30) const;

  // True if something stands between `hit` (on a surface with that normal) and `light`; the surface
  // itself does not count. A light behind the surface is occluded.
  bool occluded(const Hit& hit, const Eigen::Vector3d& light) const;

  const Scene& scene() const;

 private:
  struct Device;
  std::unique_ptr<Device> device_;
};

}  // namespace scan::synth
