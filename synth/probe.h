// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// One ray's question to the scene and the answers so far. Whoever offers the candidates, in
// whatever order, the answer is the same.
#pragma once

#include <span>

#include "synth/ray_caster.h"
#include "synth/solid.h"
#include "synth/triangle_block.h"

namespace scan::synth {

// Where the bounded solids of a scene are.
struct Arena {
  Bounds bounds;        // with the margin; empty without solids
  double margin_m = 0;  // that boxes in floats need around what they hold
  double reach_m = 0;   // no coordinate is larger
  double size_m = 0;    // diagonal of the bounds
};
Arena arena_of(std::span<const Solid> solids);

struct Probe {
  Ray ray;              // scene frame
  double origin_m = 0;  // its origin's distance from the scene's

  // Where triangles are sought from: the ray's origin or, if that lies outside of the scene's
  // bounds, its entry into them, which keeps the accuracy of rays from afar.
  bool enters = false;  // the bounds at all
  double start_m = 0;
  ShearedRay sheared_ray;
  CoarseRay coarse_ray;

  double nearest_m = std::numeric_limits<double>::infinity();
  double second_m = std::numeric_limits<double>::infinity();  // the next after the nearest
  const Solid* solid = nullptr;                               // of the answer
  std::uint32_t triangle = 0;
  Triangle corners;  // of a mesh
  double distance_m = 0;
  Eigen::Vector3d shape_normal;  // if the answer is a shape's
  bool choosing = false;         // of the hits up to `nearest_m` the lowest, not the nearest
};

// Readies the probe, of which only `ray` is set.
void enter(Probe& probe, const Arena& arena);
// The same, to the bit, of up to RaysByAxis::size probes of neighbouring rays that are wanted.
void enter(std::span<Probe> probes, std::span<const bool> wanted, const Arena& arena);

// Distance at which the ray hits the triangle or the shape, in the ray's interval and beyond the
// surface that it starts on.
std::optional<double> meet(const Probe& probe, const Solid& solid, const Triangle& corners);
std::optional<ShapeHit> meet(const Probe& probe, const Solid& shape);

// Takes a hit into account.
void offer(Probe& probe, const Solid& solid, std::uint32_t triangle, const Triangle& corners,
           double distance_m);
void offer(Probe& probe, const Solid& shape, const ShapeHit& hit);

// After all hits were offered: true if others lie at the nearest one's distance to rounding; the
// hits are then to be offered again, and the lowest object, of it the lowest triangle, wins.
bool must_choose(Probe& probe, const Arena& arena);

// What the caller is told; `origin` is the ray's, in the world.
std::optional<Hit> answer(const Probe& probe, const Eigen::Vector3d& origin);

}  // namespace scan::synth
