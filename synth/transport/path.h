// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A path on its way from the lens, and what its steps have in common.
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "synth/transport/light_transport.h"
#include "synth/transport/vertex.h"

namespace scan::synth {

// What scene and options call for; the steps of a path are compiled for each.
struct Policy {
  bool smooth = false;  // some surface reflects or transmits in single directions or lets light in
  bool media = false;   // something absorbs or scatters between surfaces
  bool lights = false;  // the scene has lights of its own
  bool emission = false;  // points lit by the emitter are sampled
};

// The far end of a way to infinity.
inline constexpr double far_m = 1e9;

// A point that the emitter lights and that is not smooth, with the emitter for `out`.
struct LitPoint {
  Vertex vertex;
  double flux = 0;       // of the sample, what was lost on its way taken off
  double optical_m = 0;  // from the emitter
  double density = 0;    // per m^2; infinite if no connection leads from here to the emitter
};

// What a path's steps change, and its branches start from.
struct Branch {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  // pi times the share of basic radiance that the way so far passes on: radiance L is pi L
  // electrons.
  double throughput = std::numbers::pi;
  double whole = std::numbers::pi;  // throughput of the branch, up to its first vertex
  double optical_m = 0;
  int scatterings = 0;
  int vertices = 0;  // the same, bodies' insides counted in full
  int smooth = 0;    // smooth surfaces in a row
  // Per sr, of `direction`; 0 if what lies ahead is found in no other way than along it: from the
  // lens and after a delta lobe.
  double density = 0;
  bool stay_counted = false;  // the stay in the translucent body around is in `scatterings`
  Surroundings around;
};

struct Path : Branch {
  const LightTransport& transport;
  const AnyEmitter& emitter;
  const AnyReceiver& receiver;
  SampleSequence& random;
  Eigen::Vector3d lens;  // not a number if the view skips a part of its way
  std::vector<Connection> ways{};
  double weight_of_ways = 1;                    // over their chance to be looked for
  std::uint64_t lit_bodies = Lamp::all_bodies;  // that the emitter lights
  Connection straight{};
  std::optional<LitPoint> lit{};
  bool lit_is_drawn = false;  // one serves all the path's vertices

  const RayCaster& caster() const { return transport.caster(); }
  const Scene& scene() const { return transport.caster().scene(); }
  // What the scene stands in; null if nothing absorbs or scatters there.
  const Medium* outside() const { return scene().medium ? &*scene().medium : nullptr; }
  const Medium* medium() const { return around.medium(outside()); }
};

// Of the path once it is scattered by a surface that it meets from `out` as well: the way out of a
// body is part of the stay there.
inline int scatterings_at(const Path& path, const Vertex& surface, const Eigen::Vector3d& out) {
  const bool is_way_out =
      path.stay_counted && surface.optics->is_transmissive && surface.hit.normal.dot(out) < 0;
  return path.scatterings + (is_way_out ? 0 : 1);
}

// Veach and Guibas' balance heuristic for one sample of each technique.
inline double balance(double density, double other_density) {
  return density / (density + other_density);
}

}  // namespace scan::synth
