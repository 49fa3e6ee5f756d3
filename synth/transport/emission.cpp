// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/emission.h"

#include <cmath>
#include <limits>

#include "synth/transport/next_event.h"

namespace scan::synth {
namespace {

double density_straight(Path& path, const Vertex& vertex) {
  const Eigen::Vector3d to_light = path.emitter.position - vertex.hit.point;
  const double length_m = to_light.norm();
  const Connection way{.arriving = to_light / length_m,
                       .emitted = -to_light / length_m,
                       .length_m = length_m,
                       .optical_m = length_m,
                       .open_m = length_m};
  return emission_density(path.emitter, vertex, way,
                          path.emitter.irradiance(way.emitted, way.length_m));
}

// Of the connection that is the emitted ray's way: directions differ by what Newton's method leaves
// and by as much as the ray passes by the place where light seems to come from; other ways by far
// more. A way that no connection finds is left to emission sampling alone.
double density_over_smooth(Path& path, const Vertex& vertex, const EmittedRay& ray, int bounces) {
  const AnyEmitter& emitter = path.emitter;
  const double aside_m = (emitter.position - ray.origin).cross(ray.direction).norm();
  Lamp lamp(emitter.position);
  lamp.lit = path.lit_bodies;  // and all directions, for those of light that is next to none
  path.transport.connector().connect(vertex.hit, lamp, path.ways);
  for (const Connection& way : path.ways)
    if (way.bounces == bounces &&
        (way.emitted - ray.direction).norm() < 1e-6 + 2 * aside_m / way.length_m)
      return emission_density(emitter, vertex, way, emitter.irradiance(way.emitted, way.length_m));
  return std::numeric_limits<double>::infinity();
}

// The emitted light on its way.
struct Beam {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  double flux = 0;
  double optical_m = 0;
  Surroundings around;
};

// On to the next surface, if there is one.
std::optional<Vertex> advance(Path& path, Beam& beam, bool is_first) {
  const auto hit = path.caster().closest(beam.origin, beam.direction);
  if (!hit) return std::nullopt;
  // the emitter's rays start where they like; the length counts from where they seem to come from
  const double length_m = is_first ? (hit->point - path.emitter.position).norm() : hit->distance_m;
  beam.optical_m += beam.around.index() * length_m;
  if (const Medium* medium = beam.around.medium(path.outside()))
    beam.flux *= transmittance(*medium, beam.origin, hit->point, path.random);
  return surface_vertex(path.scene(), path.transport.optics(hit->object), *hit, -beam.direction,
                        beam.around);
}

// Over a smooth surface; false if the light ends there.
bool pass(Path& path, Beam& beam, const Vertex& vertex) {
  const auto next = sample(vertex, path.random.next_3d());
  if (!next || !(path.transport.options().mirrors || next->is_transmitted)) return false;
  beam.flux *= next->weight;
  beam.around = around(vertex, next->in);
  beam.origin = leave(path.caster(), vertex, next->in);
  beam.direction = next->in;
  return true;
}

}  // namespace

std::optional<LitPoint> sample_lit_point(Path& path) {
  const EmittedRay emitted = path.emitter.sample(path.random.next_2d());
  Beam beam{.origin = emitted.origin, .direction = emitted.direction, .flux = emitted.flux};
  for (int smooth = 0; smooth <= path.transport.options().most_smooth; ++smooth) {
    const auto vertex = advance(path, beam, smooth == 0);
    if (!vertex) return std::nullopt;
    if (!vertex->optics->is_smooth)
      return LitPoint{.vertex = *vertex,
                      .flux = beam.flux,
                      .optical_m = beam.optical_m,
                      .density = smooth == 0 ? density_straight(path, *vertex)
                                             : density_over_smooth(path, *vertex, emitted, smooth)};
    if (!pass(path, beam, *vertex)) return std::nullopt;
  }
  return std::nullopt;
}

void add_lit_point(Path& path, const Vertex& vertex) {
  if (!path.lit_is_drawn) path.lit = sample_lit_point(path);
  path.lit_is_drawn = true;
  if (!path.lit) return;
  const Vertex& lit = path.lit->vertex;
  const Eigen::Vector3d to_lit = lit.hit.point - vertex.hit.point;
  const double length_m = to_lit.norm();
  if (!(length_m > 0)) return;
  const Eigen::Vector3d in = to_lit / length_m;
  const int scatterings = scatterings_at(path, lit, -in);
  if (scatterings > path.transport.options().most_scatterings) return;
  const Surroundings between = around(vertex, in);
  // The lit point scatters as if the light came from the path; reciprocity leaves the index between
  // (see bsdf.h; the path carries radiance over index^2).
  const double optical_m = between.index() * length_m;
  double electrons = path.throughput * scattering(vertex, in) * scattering(lit, -in) *
                     path.lit->flux / (optical_m * optical_m);
  if (!(electrons > 0)) return;
  const Eigen::Vector3d from = leave(path.caster(), vertex, in);
  if (path.caster().blocked(from, leave(path.caster(), lit, -in))) return;
  if (const Medium* medium = between.medium(path.outside()))
    electrons *= transmittance(*medium, vertex.hit.point, lit.hit.point, path.random);
  if (!std::isinf(path.lit->density))
    electrons *=
        balance(path.lit->density, density(vertex, in) * cosine(lit, in) / (length_m * length_m));
  path.receiver.device_light(electrons, path.optical_m + optical_m + path.lit->optical_m,
                             scatterings);
}

}  // namespace scan::synth
