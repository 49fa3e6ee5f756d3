// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/vertex.h"

#include <cmath>

#include "synth/frame_about.h"

namespace scan::synth {
namespace {

Eigen::Vector3d local(const Vertex& vertex, const Eigen::Vector3d& direction) {
  return vertex.world_from_local.transpose() * direction;
}

// A body inside another one refracts by the ratio of their indices.
void set_relative_index(Bsdf& bsdf, const ObjectOptics& optics, Surroundings around) {
  auto* glass = std::get_if<Dielectric>(&bsdf);
  if (!glass || !around.in_body()) return;
  around.exit(optics);
  glass->index /= around.index();
}

std::optional<Scattered> in_world(const Vertex& vertex, const std::optional<BsdfSample>& drawn) {
  if (!drawn) return std::nullopt;
  return Scattered{.in = (vertex.world_from_local * drawn->in).normalized(),
                   .weight = drawn->weight,
                   .density = drawn->is_delta ? 0 : drawn->density,
                   .is_transmitted = drawn->is_transmitted};
}

}  // namespace

Vertex surface_vertex(const Scene& scene, const ObjectOptics& optics, const Hit& hit,
                      const Eigen::Vector3d& out, const Surroundings& around) {
  Vertex vertex{.hit = optics.is_transmissive ? hit : facing(hit, -out),
                .out = out,
                .bsdf = optics.is_textured ? bsdf_at(scene, hit.object, hit.triangle, hit.point)
                                           : optics.bsdf,
                .optics = &optics,
                .around = around};
  if (optics.is_transmissive) set_relative_index(vertex.bsdf, optics, around);
  vertex.world_from_local = frame_about(vertex.hit.normal);
  return vertex;
}

Vertex medium_vertex(const Medium& medium, const Eigen::Vector3d& point, const Eigen::Vector3d& out,
                     const Surroundings& around) {
  Vertex vertex{.out = out, .phase = &medium.phase, .around = around};
  vertex.hit.point = point;
  return vertex;
}

double scattering(const Vertex& vertex, const Eigen::Vector3d& in) {
  if (vertex.phase) return phase_value(*vertex.phase, -vertex.out.dot(in));
  const Eigen::Vector3d local_in = local(vertex, in);
  return evaluate(vertex.bsdf, local(vertex, vertex.out), local_in) * std::abs(local_in.z());
}

double density(const Vertex& vertex, const Eigen::Vector3d& in) {
  if (vertex.phase) return phase_value(*vertex.phase, -vertex.out.dot(in));
  return density(vertex.bsdf, local(vertex, vertex.out), local(vertex, in));
}

double albedo(const Vertex& vertex) {
  return vertex.phase ? 1 : albedo(vertex.bsdf, local(vertex, vertex.out));
}

std::optional<Scattered> sample(const Vertex& vertex, const Eigen::Vector3d& u) {
  if (vertex.phase) {
    const Eigen::Vector3d in = sample_phase(*vertex.phase, -vertex.out, u.tail<2>());
    return Scattered{.in = in, .weight = 1, .density = density(vertex, in)};
  }
  return in_world(vertex, sample(vertex.bsdf, local(vertex, vertex.out), u));
}

std::array<std::optional<Scattered>, 2> delta_lobes(const Vertex& vertex) {
  if (!vertex.optics || !vertex.optics->has_delta) return {};
  const DeltaLobes lobes = delta_lobes(vertex.bsdf, local(vertex, vertex.out));
  return {in_world(vertex, lobes[0]), in_world(vertex, lobes[1])};
}

double cosine(const Vertex& vertex, const Eigen::Vector3d& direction) {
  return std::abs(vertex.hit.normal.dot(direction));
}

Surroundings around(const Vertex& vertex, const Eigen::Vector3d& in) {
  Surroundings there = vertex.around;
  if (!vertex.optics || !vertex.optics->is_transmissive) return there;
  const bool out_is_inside = vertex.hit.normal.dot(vertex.out) < 0;
  const bool in_is_inside = vertex.hit.normal.dot(in) < 0;
  if (in_is_inside && !out_is_inside) there.enter(*vertex.optics);
  if (!in_is_inside && out_is_inside) there.exit(*vertex.optics);
  return there;
}

Eigen::Vector3d leave(const RayCaster& caster, const Vertex& vertex,
                      const Eigen::Vector3d& direction) {
  return vertex.optics ? caster.leave(vertex.hit, direction) : vertex.hit.point;
}

}  // namespace scan::synth
