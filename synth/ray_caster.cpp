// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "libscan/core/error.h"
#include "synth/embree_tree.h"

namespace scan::synth {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr std::size_t packet = EmbreeTree::packet;

bool faces(const Hit& hit, const Eigen::Vector3d& light) {
  return hit.normal.dot(light - hit.point) > 0;
}

// Packets gain where rays point the same way and lose where they do not.
bool same_way(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.dot(b) > 0.8;
}

}  // namespace

struct RayCaster::Device {
  explicit Device(const Scene& described);

  void offer_unbounded(Probe& probe) const;
  bool hits_unbounded(const Probe& probe) const;
  std::optional<Hit> closest(const Ray& ray_in_world) const;
  void closest_of_packet(std::span<const Ray> rays_in_world,
                         std::span<std::optional<Hit>> hits) const;
  bool any(const std::optional<Ray>& ray_in_world) const;
  void any_of_packet(std::span<const std::optional<Ray>> rays_in_world,
                     std::span<bool> found) const;

  // The probe is then to enter the arena. False for a ray that is not finite.
  bool ask(const Ray& ray_in_world, Probe& probe) const {
    if (!ray_in_world.origin.allFinite() || !ray_in_world.direction.allFinite()) return false;
    probe.ray.origin = ray_in_world.origin - origin;
    probe.ray.direction = ray_in_world.direction;
    probe.ray.min_m = ray_in_world.min_m;
    probe.ray.max_m = ray_in_world.max_m;
    return true;
  }
  double rounding_at(const Hit& hit) const;
  std::optional<Ray> segment(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  Scene scene;
  Eigen::Vector3d origin;        // of the scene frame
  std::vector<Solid> unbounded;  // tested one by one
  std::vector<double> size_m;    // per object, 0 for an unbounded one
  EmbreeTree tree;
};

RayCaster::Device::Device(const Scene& described) : scene(described), origin(scene_origin(scene)) {
  std::vector<Solid> bounded;
  for (int i = 0; i < static_cast<int>(scene.objects.size()); ++i) {
    Solid solid = make_solid(scene, i, origin);
    size_m.push_back(solid.size_m);
    if (solid.bounds.isEmpty()) continue;
    (is_finite(solid.bounds) ? bounded : unbounded).push_back(std::move(solid));
  }
  if (!bounded.empty()) tree.build(std::move(bounded));
}

void RayCaster::Device::offer_unbounded(Probe& probe) const {
  for (const Solid& solid : unbounded)
    if (const auto hit = meet(probe, solid)) offer(probe, solid, *hit);
}

bool RayCaster::Device::hits_unbounded(const Probe& probe) const {
  return std::any_of(unbounded.begin(), unbounded.end(),
                     [&](const Solid& solid) { return meet(probe, solid).has_value(); });
}

std::optional<Hit> RayCaster::Device::closest(const Ray& ray) const {
  Probe probe;
  if (!ask(ray, probe)) return std::nullopt;
  enter(probe, tree.arena());
  do {
    offer_unbounded(probe);
    tree.offer_hits(probe);
  } while (!probe.choosing && must_choose(probe, tree.arena()));
  return answer(probe, ray.origin);
}

void RayCaster::Device::closest_of_packet(std::span<const Ray> rays,
                                          std::span<std::optional<Hit>> hits) const {
  if (!std::all_of(rays.begin(), rays.end(), [&](const Ray& ray) {
        return same_way(ray.direction, rays.front().direction);
      })) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = closest(rays[i]);
    return;
  }
  Probe memory[packet];
  const std::span<Probe> probes(memory, rays.size());
  bool wanted[packet] = {};
  for (std::size_t i = 0; i < rays.size(); ++i) wanted[i] = ask(rays[i], probes[i]);
  enter(probes, std::span(wanted).first(rays.size()), tree.arena());
  for (bool again = true; again;) {
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (wanted[i]) offer_unbounded(probes[i]);
    tree.offer_hits(probes, wanted);
    again = false;
    for (std::size_t i = 0; i < rays.size(); ++i)
      again |= wanted[i] = !probes[i].choosing && must_choose(probes[i], tree.arena());
  }
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = answer(probes[i], rays[i].origin);
}

bool RayCaster::Device::any(const std::optional<Ray>& ray) const {
  Probe probe;
  if (!ray || !ask(*ray, probe)) return false;
  enter(probe, tree.arena());
  return hits_unbounded(probe) || tree.any_hit(probe);
}

void RayCaster::Device::any_of_packet(std::span<const std::optional<Ray>> rays,
                                      std::span<bool> found) const {
  Probe memory[packet];
  const std::span<Probe> probes(memory, rays.size());
  bool wanted[packet] = {};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool asked = rays[i] && ask(*rays[i], probes[i]);
    found[i] = asked && hits_unbounded(probes[i]);
    wanted[i] = asked && !found[i];
  }
  enter(probes, std::span(wanted).first(rays.size()), tree.arena());
  tree.any_hit(probes, wanted, found);
}

// More than the rounding of a hit's point and of its object's coordinates.
double RayCaster::Device::rounding_at(const Hit& hit) const {
  const double object_m = hit.object >= 0 ? size_m[hit.object] : 0;
  return 128 * epsilon * (hit.point.norm() + origin.norm() + hit.distance_m + object_m);
}

// None if nothing is left of it. What stands within the rounding of its end is the end's own
// surface.
std::optional<Ray> RayCaster::Device::segment(const Eigen::Vector3d& from,
                                              const Eigen::Vector3d& to) const {
  const Eigen::Vector3d towards = to - from;
  const double length_m = towards.norm();
  const double margin_m = 32 * epsilon * (from.norm() + to.norm() + origin.norm());
  if (!(length_m > margin_m && std::isfinite(length_m))) return std::nullopt;
  return Ray{from, towards / length_m, 0, length_m - margin_m};
}

Hit facing(Hit hit, const Eigen::Vector3d& direction) {
  if (hit.normal.dot(direction) > 0) hit.normal = -hit.normal;
  return hit;
}

RayCaster::RayCaster(const Scene& scene) {
  check(scene);
  device_ = std::make_unique<Device>(scene);
}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;

const Scene& RayCaster::scene() const {
  return device_->scene;
}

std::optional<Hit> RayCaster::closest(const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction, double min_m,
                                      double max_m) const {
  return device_->closest({origin, direction, min_m, max_m});
}

void RayCaster::closest(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const {
  for (std::size_t i = 0; i < rays.size(); i += packet) {
    const std::size_t count = std::min(packet, rays.size() - i);
    device_->closest_of_packet(rays.subspan(i, count), hits.subspan(i, count));
  }
}

bool RayCaster::occluded(const Hit& hit, const Eigen::Vector3d& light) const {
  return !faces(hit, light) || blocked(leave(hit, hit.normal), light);
}

void RayCaster::occluded(std::span<const std::optional<Hit>> hits, const Eigen::Vector3d& light,
                         std::span<bool> dark) const {
  std::optional<Ray> rays[packet];
  for (std::size_t i = 0; i < hits.size(); i += packet) {
    const std::size_t count = std::min(packet, hits.size() - i);
    for (std::size_t k = 0; k < count; ++k) {
      const auto& hit = hits[i + k];
      rays[k].reset();
      if (hit && faces(*hit, light)) rays[k] = device_->segment(leave(*hit, hit->normal), light);
    }
    device_->any_of_packet({rays, count}, dark.subspan(i, count));
    for (std::size_t k = 0; k < count; ++k)
      dark[i + k] |= !hits[i + k] || !faces(*hits[i + k], light);
  }
}

Eigen::Vector3d RayCaster::leave(const Hit& hit, const Eigen::Vector3d& direction) const {
  return hit.point +
         std::copysign(device_->rounding_at(hit), hit.normal.dot(direction)) * hit.normal;
}

bool RayCaster::blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  return device_->any(device_->segment(from, to));
}

void RayCaster::blocked(std::span<const Eigen::Vector3d> from, const Eigen::Vector3d& to,
                        std::span<bool> answers) const {
  std::optional<Ray> rays[packet];
  for (std::size_t i = 0; i < from.size(); i += packet) {
    const std::size_t count = std::min(packet, from.size() - i);
    for (std::size_t k = 0; k < count; ++k) rays[k] = device_->segment(from[i + k], to);
    device_->any_of_packet({rays, count}, answers.subspan(i, count));
  }
}

}  // namespace scan::synth
