// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/light_transport.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "synth/transport/airlight.h"
#include "synth/transport/emission.h"
#include "synth/transport/next_event.h"

namespace scan::synth {
namespace {

constexpr double infinite_m = std::numeric_limits<double>::infinity();
// Vertices of a path before it may end by chance.
constexpr int sure_vertices = 3;
// Shares of the view's light: a branch below the first chooses among delta lobes by chance, so that
// this chance is worth less than 1e-2 of what it shows; one below the second stands for itself at
// its first vertex, but beyond it only some go on, for all.
constexpr double least_split = 1e-2, sure_branch = 0.25;

// Ends paths dimmer than `least` by chance, the survivors stand for them.
bool survives(Path& path, double least) {
  const double chance = path.throughput / least;
  if (chance >= 1) return true;
  if (!(path.random.next() < chance)) return false;
  path.throughput = least;
  return true;
}

template <Policy policy>
bool survives(Path& path) {
  if (path.vertices >= sure_vertices) return survives(path, path.whole);
  if (!policy.smooth || path.vertices > 1) return true;
  if (!survives(path, sure_branch * std::numbers::pi)) return false;
  path.whole = path.throughput;
  return true;
}

// Follows a stay in a translucent body: `counted` says whether the scattering that led in counts.
void follow_stay(Path& path, bool is_transmitted, bool counted) {
  if (!path.around.in_translucent_body())
    path.stay_counted = false;
  else if (is_transmitted)
    path.stay_counted = counted;
}

// On along a direction that a vertex scatters into. False if the path ends there.
template <Policy policy>
bool leave_along(Path& path, const Vertex& vertex, const Scattered& next) {
  const TransportOptions& options = path.transport.options();
  const bool is_delta = policy.smooth && next.density == 0;
  if constexpr (policy.smooth) {
    path.smooth = is_delta ? path.smooth + 1 : 0;
    if (path.smooth > options.most_smooth) return false;
    if (is_delta && !options.mirrors && !next.is_transmitted) return false;
    // a delta lobe of a surface that is not smooth: no scattering after all
    if (is_delta && !vertex.optics->is_smooth) --path.scatterings;
    path.around = around(vertex, next.in);
    if constexpr (policy.media) follow_stay(path, next.is_transmitted, !is_delta);
  }
  // after the last scattering there are the scene's lights to meet and bodies to wander in
  if (!policy.lights && !is_delta && path.scatterings >= options.most_scatterings &&
      !path.stay_counted)
    return false;
  path.throughput *= next.weight;
  path.density = next.density;
  path.origin = leave(path.caster(), vertex, next.in);
  path.direction = next.in;
  return true;
}

// The same for a direction drawn by chance; `is_split`: delta lobes are followed already.
template <Policy policy>
bool go_on(Path& path, const Vertex& vertex, bool is_split) {
  const auto next = sample(vertex, path.random.next_3d());
  if (!next || (is_split && next->density == 0)) return false;
  return leave_along<policy>(path, vertex, *next);
}

template <Policy policy>
void walk(Path& path);

// As long as the view has met nothing but delta lobes, each is followed by a branch of its own:
// what a pane shows is known, and chance would make its few dim reflections noise.
bool is_to_split(const Path& path, int scatterings_before) {
  return scatterings_before == 0 && path.throughput >= least_split * std::numbers::pi;
}

template <Policy policy>
void split(Path& path, const Vertex& vertex) {
  const Branch here = path;
  for (const auto& lobe : delta_lobes(vertex)) {
    if (lobe && leave_along<policy>(path, vertex, *lobe)) walk<policy>(path);
    static_cast<Branch&>(path) = here;
  }
}

// Whether whatever the vertex scatters further is more than the path may be.
template <Policy policy>
bool is_last(const Path& path, const Vertex& vertex) {
  if (policy.lights || path.scatterings < path.transport.options().most_scatterings) return false;
  if constexpr (policy.smooth)
    return !path.stay_counted &&
           !(vertex.optics && (vertex.optics->has_delta || vertex.optics->is_transmissive));
  return true;
}

// Adds what a surface or scattering point brings, then goes on.
template <Policy policy>
bool scatter(Path& path, const Vertex& vertex, double weight, double density_per_m2) {
  if (path.vertices++ == 0 && path.receiver.ambient_of)
    path.receiver.ambient(path.throughput / std::numbers::pi * albedo(vertex));
  add_device_light<policy>(path, vertex, weight, density_per_m2);
  if constexpr (policy.lights) add_scene_lights<policy>(path, vertex);
  if constexpr (policy.emission) add_lit_point(path, vertex);
  if (is_last<policy>(path, vertex)) return false;
  bool is_split = false;
  if constexpr (policy.smooth) {
    is_split = vertex.optics && vertex.optics->has_delta && is_to_split(path, path.scatterings - 1);
    if (is_split) split<policy>(path, vertex);
  }
  return survives<policy>(path) && go_on<policy>(path, vertex, is_split);
}

// False if the path has scattered as often as it may.
bool count_in_medium(Path& path) {
  const TransportOptions& options = path.transport.options();
  if (path.around.in_translucent_body()) {
    if (path.vertices >= options.most_in_bodies) return false;
    if (std::exchange(path.stay_counted, true)) return true;
  }
  return ++path.scatterings <= options.most_scatterings;
}

template <Policy policy>
bool meet_surface(Path& path, const Hit& hit) {
  const ObjectOptics& optics = path.transport.optics(hit.object);
  const Vertex vertex = surface_vertex(path.scene(), optics, hit, -path.direction, path.around);
  if constexpr (policy.smooth)
    if (optics.is_smooth) {
      if (!is_to_split(path, path.scatterings)) return go_on<policy>(path, vertex, false);
      split<policy>(path, vertex);
      return false;
    }
  path.scatterings = scatterings_at(path, vertex, -path.direction);
  if (path.scatterings > path.transport.options().most_scatterings) return false;
  double density_per_m2 = 0;
  if constexpr (policy.emission)
    density_per_m2 =
        path.density * cosine(vertex, path.direction) / (hit.distance_m * hit.distance_m);
  return scatter<policy>(path, vertex, 1, density_per_m2);
}

// The path's flight ended in a medium.
template <Policy policy>
bool scatter_in_medium(Path& path, double distance_m, double weight) {
  if (!count_in_medium(path)) return false;
  const Eigen::Vector3d point = path.origin + distance_m * path.direction;
  return scatter<policy>(path, medium_vertex(*path.medium(), point, -path.direction, path.around),
                         weight, 0);
}

// One straight part of the way and what it meets. False if the path ends.
template <Policy policy>
bool step(Path& path, double min_m, double max_m) {
  const auto hit = path.caster().closest(path.origin, path.direction, min_m, max_m);
  double end_m = hit ? hit->distance_m : infinite_m;
  Flight flight{.scattered_m = {}, .weight = 1};
  double weight = 1;
  if constexpr (policy.media) {
    if (const Medium* medium = path.medium())
      flight = sample_flight(*medium, path.origin, path.direction, end_m, path.random);
    if (const Medium* fog = even_fog(path)) {
      const Equiangular angles(path.emitter.brightest(path.origin, path.direction), end_m);
      add_airlight<policy>(path, *fog, angles);
      if (flight.scattered_m)
        weight =
            balance(flight_density(*fog, *flight.scattered_m), angles.density(*flight.scattered_m));
    }
    if (flight.scattered_m) end_m = *flight.scattered_m;
  }
  if constexpr (policy.lights) see_lights<policy>(path, end_m);
  if (!hit && !flight.scattered_m) return false;
  path.throughput *= flight.weight;
  path.optical_m += path.around.index() * end_m;
  return flight.scattered_m ? scatter_in_medium<policy>(path, end_m, weight)
                            : meet_surface<policy>(path, *hit);
}

template <Policy policy>
void walk(Path& path) {
  while (step<policy>(path, 0, infinite_m)) continue;
}

template <Policy policy>
void trace(const LightTransport& transport, const Ray& view, const AnyEmitter& emitter,
           SampleSequence& random, const AnyReceiver& receiver) {
  Path path{{.origin = view.origin, .direction = view.direction},
            transport,
            emitter,
            receiver,
            random,
            view.origin};
  if constexpr (policy.smooth) path.lit_bodies = transport.connector().lit_bodies(emitter);
  if (view.min_m > 0) path.lens.setConstant(std::numeric_limits<double>::quiet_NaN());
  if (step<policy>(path, view.min_m, view.max_m)) walk<policy>(path);
}

using Trace = void (*)(const LightTransport&, const Ray&, const AnyEmitter&, SampleSequence&,
                       const AnyReceiver&);

// Bits in the order of Policy's fields.
template <std::size_t... bits>
constexpr std::array<Trace, sizeof...(bits)> traces(std::index_sequence<bits...>) {
  return {trace<Policy{.smooth = (bits & 1) != 0,
                       .media = (bits & 2) != 0,
                       .lights = (bits & 4) != 0,
                       .emission = (bits & 8) != 0}>...};
}

Trace trace_for(const Scene& scene, const std::vector<ObjectOptics>& optics,
                const TransportOptions& options) {
  static constexpr auto all = traces(std::make_index_sequence<16>());
  const bool smooth = std::any_of(optics.begin(), optics.end(), [](const ObjectOptics& o) {
    return o.has_delta || o.is_transmissive;
  });
  const bool media =
      scene.medium || std::any_of(optics.begin(), optics.end(),
                                  [](const ObjectOptics& o) { return o.interior != nullptr; });
  const bool emission = options.sample_emission && (options.most_scatterings > 1 || media);
  return all[(smooth ? 1 : 0) + (media ? 2 : 0) + (scene.lights.empty() ? 0 : 4) +
             (emission ? 8 : 0)];
}

}  // namespace

TransportOptions transport_options(const EffectSet& effects, bool narrow_emitter) {
  TransportOptions options;
  const bool mirrors = effects.has(Effect::mirror_reflection);
  const bool refraction = effects.has(Effect::refraction);
  if (!effects.has(Effect::interreflection)) options.most_scatterings = 1;
  if (!mirrors && !refraction && !effects.has(Effect::subsurface)) options.most_smooth = 0;
  options.mirrors = mirrors;
  options.sample_emission =
      narrow_emitter && (effects.has(Effect::interreflection) || effects.has(Effect::subsurface));
  return options;
}

LightTransport::LightTransport(const RayCaster& caster, const TransportOptions& options)
    : caster_(caster),
      connector_(caster, options.most_smooth),
      options_(options),
      lights_(caster.scene().lights.begin(), caster.scene().lights.end()),
      optics_(optics_of(caster.scene())),
      trace_(trace_for(caster.scene(), optics_, options)) {}

}  // namespace scan::synth
