// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Next-event estimation: the light that lamps send to a point of a path.
#pragma once

#include <algorithm>
#include <span>

#include "synth/transport/path.h"

namespace scan::synth {

// Share of light that what the scene stands in lets through on a way from a light; the bodies on it
// are in Connection::throughput. In uneven fog the way counts in full, its parts in clear bodies
// too.
double share_that_arrives(Path& path, const Vertex& vertex, const Connection& way,
                          const Eigen::Vector3d& light);

// From within a translucent body ways out are looked for by chance, about as often as light gets
// out: the search takes longer than many steps of the walk inside.
double chance_to_connect(const Path& path, const Vertex& vertex, const Eigen::Vector3d& light);

// The ways from a lamp to the vertex. Where nothing bends light there is but the straight
// one, and whether it is free is asked last: see is_free.
template <Policy policy>
std::span<const Connection> connect(Path& path, const Vertex& vertex, const Lamp& lamp) {
  path.ways.clear();
  path.weight_of_ways = 1;
  if constexpr (policy.smooth && policy.media)
    if (vertex.phase && path.around.in_translucent_body()) {
      const double chance = chance_to_connect(path, vertex, lamp.position);
      path.weight_of_ways = 1 / chance;
      if (!(path.random.next() < chance)) return {};
    }
  if constexpr (policy.smooth) {
    const Connector& connector = path.transport.connector();
    if (vertex.optics)
      connector.connect(vertex.hit, lamp, path.ways);
    else
      connector.connect(vertex.hit.point, lamp, path.ways);
    if (!path.transport.options().mirrors)
      std::erase_if(path.ways, [](const Connection& way) { return way.reflections > 0; });
    return path.ways;
  }
  const Eigen::Vector3d to_light = lamp.position - vertex.hit.point;
  path.straight.length_m = path.straight.optical_m = path.straight.open_m = to_light.norm();
  path.straight.arriving = to_light / path.straight.length_m;
  path.straight.emitted = -path.straight.arriving;
  return {&path.straight, 1};
}

// Of a way that connect() gave. What the lens sees, a light at the lens lights.
template <Policy policy>
bool is_free(const Path& path, const Vertex& vertex, const Connection& way,
             const Eigen::Vector3d& light) {
  if constexpr (policy.smooth) return true;
  if (path.vertices == 1 && light == path.lens) return true;
  return !path.caster().blocked(leave(path.caster(), vertex, way.arriving), light);
}

// Electrons per irradiance that arrives along a way.
template <Policy policy>
double response(Path& path, const Vertex& vertex, const Connection& way,
                const Eigen::Vector3d& light) {
  double share = path.throughput * scattering(vertex, way.arriving);
  if constexpr (policy.smooth)
    share *=
        path.weight_of_ways * way.throughput * way.spread / (way.point_index * way.point_index);
  if constexpr (policy.media)
    if (share > 0) share *= share_that_arrives(path, vertex, way, light);
  return share;
}

// Irradiance over flux is the density with which emission sampling finds the vertex.
inline double emission_density(const AnyEmitter& emitter, const Vertex& vertex,
                               const Connection& way, double irradiance) {
  return irradiance * way.throughput * way.spread * cosine(vertex, way.arriving) / emitter.flux();
}

inline Lamp device_lamp(const Path& path) {
  Lamp lamp(path.emitter.position);
  lamp.emitter = &path.emitter;
  lamp.lit = path.lit_bodies;
  return lamp;
}

// `weight`: of the vertex among other techniques that find it; `density_per_m2`: of finding it by
// sampling a direction at the one before, 0 if emission sampling does not compete.
template <Policy policy>
void add_device_light(Path& path, const Vertex& vertex, double weight, double density_per_m2) {
  for (const Connection& way : connect<policy>(path, vertex, device_lamp(path))) {
    const double irradiance = path.emitter.irradiance(way.emitted, way.length_m);
    if (!(irradiance > 0)) continue;
    double electrons =
        weight * irradiance * response<policy>(path, vertex, way, path.emitter.position);
    if constexpr (policy.emission)
      if (density_per_m2 > 0 && !way.over_coat)  // emitted rays end on coats
        electrons *=
            balance(density_per_m2, emission_density(path.emitter, vertex, way, irradiance));
    if (electrons > 0 && is_free<policy>(path, vertex, way, path.emitter.position))
      path.receiver.device_light(electrons, path.optical_m + way.optical_m, path.scatterings);
  }
}

template <Policy policy>
void add_point_light(Path& path, const Vertex& vertex, const PointLight& light) {
  for (const Connection& way : connect<policy>(path, vertex, light.position_m)) {
    const double irradiance = light.intensity_w_sr / (way.length_m * way.length_m);
    const double electrons = irradiance * response<policy>(path, vertex, way, light.position_m);
    if (electrons > 0 && is_free<policy>(path, vertex, way, light.position_m))
      path.receiver.other_light(electrons);
  }
}

template <Policy policy>
void add_light(Path& path, const Vertex& vertex, const PreparedLight& light) {
  if (const auto* point = std::get_if<PointLight>(&light.light))
    return add_point_light<policy>(path, vertex, *point);
  const LightSample drawn = sample_light(light, vertex.hit.point, path.random.next_2d());
  if (!(drawn.density > 0 && drawn.radiance > 0)) return;
  double electrons = path.throughput * scattering(vertex, drawn.direction) * drawn.radiance /
                     (drawn.density + density(vertex, drawn.direction));
  if (!(electrons > 0)) return;
  const double length_m = std::min(drawn.distance_m, far_m);
  const Eigen::Vector3d from = leave(path.caster(), vertex, drawn.direction);
  if (path.caster().blocked(from, from + length_m * drawn.direction)) return;
  if constexpr (policy.media)
    if (const Medium* medium = around(vertex, drawn.direction).medium(path.outside()))
      electrons *= transmittance(*medium, from, from + length_m * drawn.direction, path.random);
  path.receiver.other_light(electrons);
}

template <Policy policy>
void add_scene_lights(Path& path, const Vertex& vertex) {
  for (const PreparedLight& light : path.transport.lights()) add_light<policy>(path, vertex, light);
}

// The scene's lights that the path's direction itself meets before `end_m` (infinite: it meets
// nothing).
template <Policy policy>
void see_lights(Path& path, double end_m) {
  for (const PreparedLight& light : path.transport.lights()) {
    const LightSample seen = light_along(light, path.origin, path.direction);
    if (!(seen.radiance > 0) || seen.distance_m > end_m) continue;
    double electrons = path.throughput * seen.radiance;
    if (path.density > 0) electrons *= balance(path.density, seen.density);
    if constexpr (policy.media) {
      const Medium* medium = path.medium();
      if (medium && medium->scattering_per_m == 0)  // else its flight got here by chance
        electrons *= transmittance(*medium, path.origin,
                                   path.origin + std::min(seen.distance_m, far_m) * path.direction,
                                   path.random);
    }
    path.receiver.other_light(electrons);
  }
}

}  // namespace scan::synth
