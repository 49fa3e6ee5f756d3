// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/connection.h"

#include <algorithm>
#include <cmath>

#include "synth/bsdf/fresnel.h"
#include "synth/transport/chain_starts.h"

namespace scan::synth {
namespace {

constexpr double least_throughput = 1e-7;
constexpr int most_facet_walks = 8;

// The end that light is to reach: a point of a surface or in space.
struct Receiver {
  const RayCaster& caster;
  Eigen::Vector3d point;
  const Hit* hit = nullptr;

  // An opaque surface is lit from its normal's side only.
  bool faces(const Eigen::Vector3d& arriving) const {
    if (!hit || hit->normal.dot(arriving) > 0) return true;
    const Scene& scene = caster.scene();
    const Material& material = scene.materials[scene.objects[hit->object].material];
    return hit->normal.dot(arriving) < 0 && std::holds_alternative<Dielectric>(material.bsdf);
  }
  Eigen::Vector3d left_along(const Eigen::Vector3d& direction) const {
    return hit ? caster.leave(*hit, direction) : point;
  }
};

Connection straight(const Eigen::Vector3d& way) {
  const double length_m = way.norm();
  return {.arriving = way / length_m,
          .emitted = -way / length_m,
          .length_m = length_m,
          .optical_m = length_m,
          .open_m = length_m};
}

bool is_straight_free(const Receiver& at, const Eigen::Vector3d& light) {
  const Eigen::Vector3d way = light - at.point;
  return at.faces(way) && !at.caster.blocked(at.left_along(way), light);
}

// Share of the power that takes the turn; `cosine` to the normal.
double fresnel_share(const SmoothSurfaces& surfaces, const Turn& turn, double cosine) {
  const Bsdf& bsdf = surfaces.body_of(turn.sheet).bsdf;
  if (const auto* metal = std::get_if<Conductor>(&bsdf))
    return fresnel_conductor(cosine, metal->eta, metal->k);
  if (const auto* coat = std::get_if<Plastic>(&bsdf))
    return turn.from_inside ? 0 : fresnel_dielectric(cosine, coat->index);
  const double reflected = fresnel_dielectric(cosine, relative_index(surfaces, turn));
  return turn.reflects ? reflected : 1 - reflected;
}

// The clear body around each part of the way, -1 for none. A turn at a clear body tells what lies
// before and behind it; a mirror leaves the ray where it is.
std::array<int, Connection::most_bounces + 1> surroundings(const SmoothSurfaces& surfaces,
                                                           const Chain& chain) {
  std::array<int, Connection::most_bounces + 1> around;
  around.fill(-1);
  bool is_known = false;
  for (int i = 0; i < chain.size; ++i) {
    const Turn& turn = chain.turns[i];
    const int body = surfaces.sheets[turn.sheet].body;
    around[i + 1] = around[i];
    if (!surfaces.bodies[body].is_clear) continue;
    if (!is_known) std::fill_n(around.begin(), i + 1, turn.from_inside ? body : -1);
    is_known = true;
    around[i + 1] = turn.from_inside == turn.reflects ? body : -1;
  }
  return around;
}

// The shot as a way, with all but its visibility.
Connection measured(const SmoothSurfaces& surfaces, const Chain& chain, const Shot& shot,
                    const Eigen::Vector3d& from, const Eigen::Vector3d& target) {
  Connection way{.arriving = shot.directions[0],
                 .emitted = (shot.points[chain.size - 1] - target).normalized(),
                 .bounces = chain.size};
  const auto around = surroundings(surfaces, chain);
  Eigen::Vector3d point = from;
  double depth = 0;
  for (int i = 0; i <= chain.size; ++i) {
    const Eigen::Vector3d& next = i < chain.size ? shot.points[i] : target;
    const double part_m = (next - point).norm();
    way.length_m += part_m;
    way.optical_m += part_m * (around[i] < 0 ? 1 : surfaces.bodies[around[i]].index);
    if (around[i] < 0)
      way.open_m += part_m;
    else
      depth += part_m * surfaces.bodies[around[i]].extinction_per_m;
    point = next;
    if (i == chain.size) break;
    way.bends[i] = surfaces.origin + next;
    way.reflections += chain.turns[i].reflects ? 1 : 0;
    way.over_coat |= std::holds_alternative<Plastic>(surfaces.body_of(chain.turns[i].sheet).bsdf);
    way.throughput *=
        fresnel_share(surfaces, chain.turns[i], std::abs(shot.normals[i].dot(shot.directions[i])));
  }
  way.throughput *= std::exp(-depth);
  // Etendue is kept: n^2 d(solid angle) d(area across) is the same at both ends.
  if (around[0] >= 0) way.point_index = surfaces.bodies[around[0]].index;
  const double index_ratio =
      way.point_index / (around[chain.size] < 0 ? 1 : surfaces.bodies[around[chain.size]].index);
  way.spread = way.length_m * way.length_m * index_ratio * index_ratio /
               std::abs(shot.gradient.determinant());
  return way;
}

// The whole scene, too, meets the chain's sheets one after the other, and nothing after the last.
bool is_free(const SmoothSurfaces& surfaces, const Chain& chain, const Shot& shot,
             const Receiver& at, const Eigen::Vector3d& light) {
  if (!at.faces(shot.directions[0])) return false;
  Eigen::Vector3d from = at.left_along(shot.directions[0]);
  const double tolerance_m = 1e-8 * (light - at.point).norm();
  for (int i = 0; i < chain.size; ++i) {
    const Eigen::Vector3d aim = surfaces.origin + shot.points[i];
    const auto hit = at.caster.closest(from, (aim - from).normalized());
    if (!hit || (hit->point - aim).norm() > tolerance_m) return false;
    const int body = surfaces.sheets[chain.turns[i].sheet].body;
    if (hit->object != surfaces.bodies[body].object ||
        surfaces.sheet_at(body, hit->triangle, hit->normal) != chain.turns[i].sheet)
      return false;
    from = at.caster.leave(*hit, shot.directions[i + 1]);
  }
  return !at.caster.blocked(from, light);
}

bool is_known(const std::vector<Connection>& ways, const Connection& way) {
  return std::any_of(ways.begin(), ways.end(), [&](const Connection& known) {
    return known.bounces == way.bounces && (known.arriving - way.arriving).norm() < 1e-7 &&
           std::abs(known.optical_m - way.optical_m) < 1e-9 * way.optical_m;
  });
}

// The search from one receiver to one light.
class Search {
 public:
  Search(const SmoothSurfaces& surfaces, int most, const Receiver& at, const Lamp& lamp,
         std::vector<Connection>& ways)
      : surfaces_(surfaces),
        most_(most),
        at_(at),
        lamp_(lamp),
        from_(at.point - surfaces.origin),
        target_(lamp.position - surfaces.origin),
        ways_(ways) {}

  void run() {
    std::vector<Start> starts;
    if (lamp_.lit == Lamp::all_bodies) {  // else it lights no clear body
      Chain straight;
      if (ways_.empty()) straight = over({.direction = (target_ - from_).normalized()});
      add_aims(surfaces_, from_, target_, straight, starts);
    }
    add_images(surfaces_, from_, lamp_, most_, starts);
    add_curved_starts(surfaces_, from_, lamp_, most_, starts);
    for (const Start& start : starts) over(start);
  }

 private:
  // Solves the chain that the start leads into; where its facets end before the solution, goes on
  // with the chain that the solution leads into. Returns the first chain.
  Chain over(Start start) {
    Chain first;
    for (int walk = 0; walk < most_facet_walks; ++walk) {
      const auto chain = follow(surfaces_, start,
                                at_.left_along(start.direction) - surfaces_.origin, target_, most_);
      if (walk == 0 && chain) first = *chain;
      if (!chain || was_tried(*chain)) break;
      const auto shot = solve(surfaces_, *chain, from_, start.direction, target_);
      if (!shot) break;
      if (take(*chain, *shot)) break;
      start.direction = shot->directions[0];
    }
    return first;
  }

  bool is_flat(const Chain& chain) const {
    for (int i = 0; i < chain.size; ++i)
      if (!surfaces_.sheets[chain.turns[i].sheet].is_flat) return false;
    return true;
  }

  // A chain of facets has one solution.
  bool was_tried(const Chain& chain) {
    if (!is_flat(chain)) return false;
    if (std::find(tried_.begin(), tried_.end(), chain) != tried_.end()) return true;
    tried_.push_back(chain);
    return false;
  }

  // False if the solution may lie beyond the end of a facet.
  bool take(const Chain& chain, const Shot& shot) {
    const Connection way = measured(surfaces_, chain, shot, from_, target_);
    if (lamp_.emitter && !(lamp_.emitter->irradiance(way.emitted, way.length_m) > 0))
      return !is_flat(chain);
    if (!is_free(surfaces_, chain, shot, at_, lamp_.position)) return false;
    if (way.throughput >= least_throughput && std::isfinite(way.spread) && !is_known(ways_, way))
      ways_.push_back(way);
    return true;
  }

  const SmoothSurfaces& surfaces_;
  int most_;
  const Receiver& at_;
  const Lamp& lamp_;
  Eigen::Vector3d from_, target_;
  std::vector<Connection>& ways_;
  std::vector<Chain> tried_;
};

void find_ways(const SmoothSurfaces* surfaces, int most, const Receiver& at, const Lamp& lamp,
               std::vector<Connection>& ways) {
  ways.clear();
  const Eigen::Vector3d way = lamp.position - at.point;
  if (!(way.squaredNorm() > 0)) return;
  if (is_straight_free(at, lamp.position)) ways.push_back(straight(way));
  if (!surfaces || lamp.lit == 0) return;
  Search(*surfaces, most, at, lamp, ways).run();
  std::sort(ways.begin(), ways.end(), [](const Connection& a, const Connection& b) {
    return std::pair(a.bounces > 0, a.optical_m) < std::pair(b.bounces > 0, b.optical_m);
  });
}

}  // namespace

Connector::Connector(const RayCaster& caster, int most_bounces)
    : caster_(caster), most_bounces_(std::min(most_bounces, Connection::most_bounces)) {
  if (most_bounces_ > 0 && !smooth_objects(caster.scene()).empty())
    surfaces_ = std::make_shared<const SmoothSurfaces>(caster.scene());
}

void Connector::connect(const Hit& at, const Lamp& lamp, std::vector<Connection>& ways) const {
  find_ways(surfaces_.get(), most_bounces_, {caster_, at.point, &at}, lamp, ways);
}

void Connector::connect(const Eigen::Vector3d& at, const Lamp& lamp,
                        std::vector<Connection>& ways) const {
  find_ways(surfaces_.get(), most_bounces_, {caster_, at}, lamp, ways);
}

std::uint64_t Connector::lit_bodies(const AnyEmitter& emitter) const {
  if (!surfaces_) return 0;
  std::uint64_t lit = 0;
  for (std::size_t i = 0; i < surfaces_->bodies.size(); ++i) {
    const SmoothBody& body = surfaces_->bodies[i];
    const bool is_bounded = body.size_m > 0;
    const bool is_lit =
        !is_bounded || emitter.reaches(surfaces_->origin + body.centre, body.size_m / 2);
    if (is_lit && body.is_clear) return Lamp::all_bodies;
    if (is_lit) lit |= Lamp::bit(static_cast<int>(i));
  }
  return lit;
}

}  // namespace scan::synth
