// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where a path is scattered: a point of a surface or in a medium, behind one set of functions.
#pragma once

#include <array>
#include <optional>

#include "synth/ray_caster.h"
#include "synth/transport/surroundings.h"

namespace scan::synth {

// `out` and `in` are unit, world frame, away from the vertex, along the light's way backwards: it
// goes along `out` and comes from `in`.
struct Vertex {
  Hit hit;  // object -1 in a medium; of a surface that lets no light through, the
            // normal is on the side of `out`
  Eigen::Vector3d out;
  Eigen::Matrix3d world_from_local;
  Bsdf bsdf;
  const ObjectOptics* optics = nullptr;  // null in a medium
  const PhaseFunction* phase = nullptr;  // null on a surface
  Surroundings around;                   // on the side of `out`
};

Vertex surface_vertex(const Scene& scene, const ObjectOptics& optics, const Hit& hit,
                      const Eigen::Vector3d& out, const Surroundings& around);
Vertex medium_vertex(const Medium& medium, const Eigen::Vector3d& point, const Eigen::Vector3d& out,
                     const Surroundings& around);

// BSDF times |cosine| of `in`, or the phase function; per sr, without delta lobes.
double scattering(const Vertex& vertex, const Eigen::Vector3d& in);
// Of sample() giving `in`, per sr; 0 of delta lobes.
double density(const Vertex& vertex, const Eigen::Vector3d& in);

// Share of uniform light from all sides that goes along `out`; what a body loses inside is not
// counted.
double albedo(const Vertex& vertex);

struct Scattered {
  Eigen::Vector3d in;
  double weight = 0;   // scattering over density
  double density = 0;  // 0 of a delta lobe
  bool is_transmitted = false;
};
// None if the light is absorbed.
std::optional<Scattered> sample(const Vertex& vertex, const Eigen::Vector3d& u);

// Along each single direction, the brightest first; `weight` is its share of the light.
std::array<std::optional<Scattered>, 2> delta_lobes(const Vertex& vertex);

// |cosine| between the surface's normal and a direction.
double cosine(const Vertex& vertex, const Eigen::Vector3d& direction);
// What light that arrives from `in` travels in.
Surroundings around(const Vertex& vertex, const Eigen::Vector3d& in);
// Where a ray along `direction` starts, off the surface.
Eigen::Vector3d leave(const RayCaster& caster, const Vertex& vertex,
                      const Eigen::Vector3d& direction);

}  // namespace scan::synth
