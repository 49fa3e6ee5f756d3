// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/probe.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "synth/packet_entry.h"

namespace scan::synth {
namespace {

// True if the hit becomes the answer.
bool accept(Probe& probe, const Solid& solid, std::uint32_t triangle, double distance_m) {
  if (probe.choosing) {
    if (distance_m > probe.nearest_m) return false;
    if (probe.solid &&
        std::pair(probe.solid->object, probe.triangle) < std::pair(solid.object, triangle))
      return false;
  } else if (distance_m >= probe.nearest_m) {
    probe.second_m = std::min(probe.second_m, distance_m);
    return false;
  } else {
    probe.second_m = std::exchange(probe.nearest_m, distance_m);
  }
  probe.solid = &solid;
  probe.triangle = triangle;
  probe.distance_m = distance_m;
  return true;
}

// Inside the bounds from there on.
void begin(Probe& probe, double start_m, const Arena& arena) {
  const Ray& ray = probe.ray;
  probe.enters = true;
  probe.start_m = start_m;
  shear(ray.origin + start_m * ray.direction, ray.direction, probe.sheared_ray);
  round_off(probe.sheared_ray, arena.reach_m, probe.coarse_ray);
}

}  // namespace

// A float ray starts where the double one does and ends inside the bounds, so start, direction and
// box are each off by float rounding of the bounds' size at most; 16 covers their sum.
Arena arena_of(std::span<const Solid> solids) {
  Arena arena;
  for (const Solid& solid : solids) arena.bounds.extend(solid.bounds);
  if (arena.bounds.isEmpty()) return arena;
  arena.margin_m = 16 * std::numeric_limits<float>::epsilon() * arena.bounds.diagonal().norm();
  arena.bounds.min().array() -= arena.margin_m;
  arena.bounds.max().array() += arena.margin_m;
  arena.reach_m =
      std::max(arena.bounds.min().cwiseAbs().maxCoeff(), arena.bounds.max().cwiseAbs().maxCoeff());
  arena.size_m = arena.bounds.diagonal().norm();
  return arena;
}

void enter(Probe& probe, const Arena& arena) {
  const Ray& ray = probe.ray;
  const Bounds& bounds = arena.bounds;
  probe.origin_m = ray.origin.norm();
  if (bounds.contains(ray.origin))
    begin(probe, 0, arena);
  else if (const auto span = bounds.isEmpty() ? std::nullopt : clip(bounds, ray))
    begin(probe, span->enter_m, arena);
}

void enter(std::span<Probe> probes, std::span<const bool> wanted, const Arena& arena) {
  RaysByAxis rays;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    if (!wanted[i]) continue;
    const Ray& ray = probes[i].ray;
    probes[i].origin_m = ray.origin.norm();
    for (int axis = 0; axis < 3; ++axis) {
      rays.origin[axis][i] = ray.origin(axis);
      rays.direction[axis][i] = ray.direction(axis);
    }
    rays.min_m[i] = ray.min_m;
    rays.max_m[i] = ray.max_m;
  }
  if (arena.bounds.isEmpty()) return;
  const Eigen::Vector3d &low = arena.bounds.min(), &high = arena.bounds.max();
  double start_m[RaysByAxis::size];
  find_entries(rays, {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}}, start_m);
  for (std::size_t i = 0; i < probes.size(); ++i)
    if (wanted[i] && start_m[i] < std::numeric_limits<double>::infinity())
      begin(probes[i], start_m[i], arena);
}

std::optional<double> meet(const Probe& probe, const Solid& solid, const Triangle& corners) {
  const auto [a, b, c] = corners;
  const auto beyond =
      line_distance(probe.sheared_ray, solid.vertices[a], solid.vertices[b], solid.vertices[c]);
  if (!beyond) return std::nullopt;
  const double distance_m = probe.start_m + *beyond;
  const double nearest_m = std::max(probe.ray.min_m, rounding_m(probe.origin_m, solid.size_m));
  if (!(distance_m > nearest_m && distance_m < probe.ray.max_m)) return std::nullopt;
  return distance_m;
}

std::optional<ShapeHit> meet(const Probe& probe, const Solid& shape) {
  return intersect(shape.shape, probe.ray);
}

void offer(Probe& probe, const Solid& solid, std::uint32_t triangle, const Triangle& corners,
           double distance_m) {
  if (accept(probe, solid, triangle, distance_m)) probe.corners = corners;
}

void offer(Probe& probe, const Solid& shape, const ShapeHit& hit) {
  if (accept(probe, shape, 0, hit.distance_m)) probe.shape_normal = hit.normal;
}

bool must_choose(Probe& probe, const Arena& arena) {
  if (!probe.solid) return false;
  const double same_m = rounding_m(probe.origin_m + probe.nearest_m, arena.size_m);
  if (!(probe.second_m <= probe.nearest_m + same_m)) return false;
  probe.nearest_m += same_m;
  probe.choosing = true;
  probe.solid = nullptr;
  return true;
}

// The hit is where the ray meets the plane of corners that are off by less than rounding_m.
std::optional<Hit> answer(const Probe& probe, const Eigen::Vector3d& origin) {
  if (!probe.solid) return std::nullopt;
  const Solid& solid = *probe.solid;
  const Eigen::Vector3d& direction = probe.ray.direction;
  const Eigen::Vector3d normal =
      solid.is_mesh ? normal_of(solid, probe.corners) : probe.shape_normal;
  const double off_m = rounding_m(probe.origin_m + probe.distance_m, solid.size_m);
  return Hit{.distance_m = probe.distance_m,
             .point = origin + probe.distance_m * direction,
             .normal = normal,
             .object = solid.object,
             .triangle = probe.triangle,
             .error_m = off_m / std::max(std::abs(normal.dot(direction)), 1e-300)};
}

}  // namespace scan::synth
