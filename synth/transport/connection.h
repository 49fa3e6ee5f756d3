// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How light gets from a point light to a point: straight, through glass, over mirrors.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "synth/ray_caster.h"
#include "synth/transport/device.h"

namespace scan::synth {

class SmoothSurfaces;

// One way from the light to a point. Irradiance on a surface facing `arriving` is the emitter's
// irradiance(emitted, length_m) times throughput times spread; paths that carry radiance over
// index^2 add it over point_index^2.
struct Connection {
  static constexpr int most_bounces = 8;

  Eigen::Vector3d arriving;  // unit, from the point towards where the light comes from
  Eigen::Vector3d emitted;   // unit, of travel at the light
  double length_m = 0;       // geometric length of the way
  double optical_m = 0;      // each part times its index
  double throughput = 1;     // product of Fresnel shares and absorption in clear bodies
  double spread =
      1;  // length^2 d(solid angle at the light) / d(area across the light): 1 if straight
  int bounces = 0;         // smooth surfaces on the way
  int reflections = 0;     // those of them that reflect it
  bool over_coat = false;  // one of them is a smooth coat, which is not smooth below
  double open_m = 0;       // the part of the length that is in no clear body: in air or fog
  double point_index = 1;  // of the clear body that the point lies in
  // Where the way meets the smooth surfaces, from the point to the light.
  std::array<Eigen::Vector3d, most_bounces> bends;
};

// Where light comes from.
struct Lamp {
  Lamp(const Eigen::Vector3d& point) : position(point) {}

  Eigen::Vector3d position;
  const AnyEmitter* emitter = nullptr;  // none: it shines to all sides
  // A bit for each smooth body that it may light straight, those from the 63rd on have one
  // together; all, if one of these is clear and thus may send the light anywhere.
  std::uint64_t lit = all_bodies;

  static constexpr std::uint64_t all_bodies = ~std::uint64_t{0};
  static std::uint64_t bit(int body) { return std::uint64_t{1} << std::min(body, 63); }
  bool lights(int body) const { return (lit & bit(body)) != 0; }
};

// The scene's smooth surfaces (mirrors, clear bodies, smooth coats), found once. Clear bodies stand
// in air: their outside has index 1.
//
// Which ways are found:
//   straight; through clear bodies, with refraction at every surface on the way;
//   over facets (of boxes, planes, cylinders' ends, meshes), also glass facets from outside and
//   inside, for every sequence of as many facets in a row as keep facets^number below 200 (a box:
//   2, so a pane's transmission includes its double inner reflection; two flat mirrors: 7), with
//   clear bodies in between;
//   over one curved surface, and through one curved body with none or one inner reflection, from
//   several starts spread over it; of faceted curves, what facets show.
// Not found: reflections between two curved surfaces, or from a curved one to a facet. Grazing
// light and ways of a throughput below 1e-7 are left out.
class Connector {
 public:
  // Ways over at most `most_bounces` smooth surfaces, never more than Connection's. Throws
  // scan::Error (input) for a clear body whose interior is a grid.
  Connector(const RayCaster& caster, int most_bounces);

  // Replaces what `ways` holds. An opaque surface is lit from the side of `at.normal` only, so turn
  // it towards the viewer (see facing); a dielectric one from both sides.
  // All ways from `lamp` to the surface point `at` that were found, the straight one first if it
  // is free, then by optical length; other surfaces between block it. Ways over smooth surfaces
  // solve Fermat's principle by Newton's method on the direction that leaves `at`, started from the
  // straight line (refraction) and from each mirror or glass facet's reflection of the light; of a
  // curved mirror's several solutions those nearest to the starts are found. The same for any
  // thread. Ways over smooth surfaces that leave a lamp where it does not shine are left out.
  void connect(const Hit& at, const Lamp& lamp, std::vector<Connection>& ways) const;
  // From a point in free space, such as one in fog, or inside a clear body.
  void connect(const Eigen::Vector3d& at, const Lamp& lamp, std::vector<Connection>& ways) const;

  // For Lamp::lit.
  std::uint64_t lit_bodies(const AnyEmitter& emitter) const;

  bool straight_only() const { return !surfaces_; }

 private:
  const RayCaster& caster_;
  std::shared_ptr<const SmoothSurfaces> surfaces_;  // none if the scene has no smooth surface
  int most_bounces_;
};

}  // namespace scan::synth
