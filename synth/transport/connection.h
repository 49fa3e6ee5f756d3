// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How light gets from a point light to a point: straight, through glass, over mirrors.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "synth/ray_caster.h"

namespace scan::synth {

// One way from the light to a point. Irradiance on a surface facing `arriving` is the emitter's
// irradiance(emitted, length_m) times throughput times spread.
struct Connection {
  Eigen::Vector3d arriving;  // unit, from the point towards where the light comes from
  Eigen::Vector3d emitted;   // unit, of travel at the light
  double length_m = 0;       // geometric length of the way
  double optical_m = 0;      // each part times its index
  double throughput = 1;     // product of Fresnel shares and absorption in clear bodies
  double spread =
      1;  // length^2 d(solid angle at the light) / d(area across the light): 1 if straight
  int bounces = 0;  // smooth surfaces on the way
};

// The scene's smooth surfaces (mirrors, clear glass), found once.
class Connector {
 public:
  // Ways over at most `most_bounces` smooth surfaces.
  Connector(const RayCaster& caster, int most_bounces);

  // All ways from `light` to the surface point `at` that were found, the straight one first if it
  // is free; other surfaces between block it. Ways over smooth surfaces solve Fermat's principle by
  // Newton's method on the direction that leaves `at`, started from the straight line (refraction)
  // and from each mirror or glass facet's reflection of the light; of a curved mirror's several
  // solutions those nearest to the starts are found. The same for any thread.
  void connect(const Hit& at, const Eigen::Vector3d& light, std::vector<Connection>& ways) const;
  // From a point in free space, such as one in fog.
  void connect(const Eigen::Vector3d& at, const Eigen::Vector3d& light,
               std::vector<Connection>& ways) const;

  bool straight_only() const { return smooth_objects_.empty(); }

 private:
  const RayCaster& caster_;
  std::vector<int> smooth_objects_;
  int most_bounces_;
};

}  // namespace scan::synth
