// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Rays against a scene: Embree finds the candidate, double precision decides where it is.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "synth/scene.h"
#include "synth/shape_rays.h"

namespace scan::synth {

struct Hit {
  double distance_m = 0;  // along the unit direction
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  // geometric, unit, outward of the object
  int object = -1;
  std::uint32_t triangle = 0;  // of a mesh
  double error_m = 0;          // bound of the rounding of the distance
};

// The same hit as seen along `direction`: its normal turned against the ray. Shells reflect on both
// sides, and a scanner sees the side that it looks at.
Hit facing(Hit hit, const Eigen::Vector3d& direction);

// Built once per scene, used from many threads. Embree's tree (ROBUST, floats relative to the
// scene's own origin, widened boxes) only proposes blocks of triangles and shapes, floats with a
// bound of their rounding leave some of them; who is hit and where is decided in double precision,
// so a scene far from the origin keeps its accuracy, and nothing depends on Embree, on the order of
// its search or on the processor. Triangles are tested without leaks at shared edges and vertices;
// triangles without area are never hit. Analytic shapes: see shape_rays.h.
class RayCaster {
 public:
  // Checks the scene first: throws scan::Error (input).
  explicit RayCaster(const Scene& scene);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;

  // First hit with distance in (min_m, max_m); `direction` unit, world frame. Among hits at the
  // same distance (to rounding) the lowest object wins, then the lowest triangle. A ray that starts
  // on a surface does not hit it at distance zero; one that starts inside an object hits it from
  // inside, with the outward normal along the ray. An origin or direction that is not finite hits
  // nothing.
  std::optional<Hit> closest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double min_m = 0, double max_m = 1e30) const;

  // The same for rays of the world frame, to the bit, and faster if neighbours in the list are
  // neighbours in space, as in a row of an image. As many hits as rays.
  void closest(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;

  // True if something stands between `hit` (on a surface with that normal) and `light`; the surface
  // itself does not count. A light behind or in the plane of the surface is occluded.
  bool occluded(const Hit& hit, const Eigen::Vector3d& light) const;

  // The same for neighbouring hits; what is not there is dark.
  void occluded(std::span<const std::optional<Hit>> hits, const Eigen::Vector3d& light,
                std::span<bool> dark) const;

  // Start of a secondary ray: off the surface of the hit, on the side that `direction` points to,
  // by more than the rounding of the hit and of its object's coordinates.
  Eigen::Vector3d leave(const Hit& hit, const Eigen::Vector3d& direction) const;

  // True if something stands between two points that are in free space or off their surfaces (made
  // with `leave`).
  bool blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  // The same for neighbouring points.
  void blocked(std::span<const Eigen::Vector3d> from, const Eigen::Vector3d& to,
               std::span<bool> answers) const;

  const Scene& scene() const;

 private:
  struct Device;
  std::unique_ptr<Device> device_;
};

}  // namespace scan::synth
