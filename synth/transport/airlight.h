// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The emitter's light that even fog scatters into a path, dense where the emitter is near.
#pragma once

#include <cmath>

#include "synth/transport/equiangular.h"
#include "synth/transport/next_event.h"

namespace scan::synth {

// Fog around the path, in which light near the emitter is bright: there the flight's distances and
// equal angles are two techniques for one scattering, under the balance heuristic.
inline const Medium* even_fog(const Path& path) {
  const Medium* fog = path.around.in_body() ? nullptr : path.outside();
  return fog && fog->scattering_per_m > 0 && std::holds_alternative<Homogeneous>(fog->density)
             ? fog
             : nullptr;
}

inline double flight_density(const Medium& fog, double distance_m) {
  const double extinction = extinction_per_m(fog);
  return extinction * std::exp(-extinction * distance_m);
}

// The light that fog scatters into the path's direction from one distance before `end_m`.
template <Policy policy>
void add_airlight(Path& path, const Medium& fog, const Equiangular& angles) {
  if (path.scatterings == path.transport.options().most_scatterings) return;
  const double distance_m = angles.sample(path.random.next());
  const double by_flight = flight_density(fog, distance_m);
  const double throughput = path.throughput, optical_m = path.optical_m;
  path.throughput *= by_flight * fog.scattering_per_m / extinction_per_m(fog);
  path.optical_m += distance_m;
  ++path.scatterings;
  ++path.vertices;
  const Vertex vertex =
      medium_vertex(fog, path.origin + distance_m * path.direction, -path.direction, path.around);
  add_device_light<policy>(path, vertex, 1 / (by_flight + angles.density(distance_m)), 0);
  path.throughput = throughput;
  path.optical_m = optical_m;
  --path.scatterings;
  --path.vertices;
}

}  // namespace scan::synth
