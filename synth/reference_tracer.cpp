// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/reference_tracer.h"

#include <algorithm>
#include <array>
#include <utility>

#include "synth/probe.h"

namespace scan::synth {
namespace {

// A triangle, or a whole shape, of a solid.
struct Part {
  const Solid* solid;
  std::uint32_t triangle;
};

struct Node {
  Bounds box;
  std::vector<Part> parts;  // of a leaf
  std::array<std::unique_ptr<Node>, 8> children;
};

struct Found {
  double distance_m;
  Part part;
  std::optional<ShapeHit> shape;
};

Bounds bounds_of_part(const Solid& solid, std::uint32_t triangle) {
  if (!solid.is_mesh) return solid.bounds;
  Bounds box;
  for (const std::uint32_t corner : solid.triangles[triangle]) box.extend(solid.vertices[corner]);
  return box;
}

Bounds child_box(const Bounds& box, int octant) {
  const Eigen::Vector3d middle = box.center();
  Bounds child = box;
  for (int axis = 0; axis < 3; ++axis)
    (octant >> axis & 1 ? child.min() : child.max())(axis) = middle(axis);
  return child;
}

}  // namespace

struct ReferenceTracer::World {
  explicit World(const Scene& scene);
  std::unique_ptr<Node> grow(const Bounds& box, std::vector<Part> parts, int depth) const;
  void test(const Part& part, const Probe& probe, std::vector<Found>& found) const;
  void walk(const Node& node, const Probe& probe, std::vector<Found>& found) const;
  std::vector<Found> all_hits(const Probe& probe) const;

  Eigen::Vector3d origin;
  std::vector<Solid> bounded, unbounded;
  Arena arena;
  std::unique_ptr<Node> root;
};

ReferenceTracer::World::World(const Scene& scene) : origin(scene_origin(scene)) {
  for (int i = 0; i < static_cast<int>(scene.objects.size()); ++i) {
    Solid solid = make_solid(scene, i, origin);
    if (solid.bounds.isEmpty()) continue;
    (is_finite(solid.bounds) ? bounded : unbounded).push_back(std::move(solid));
  }
  arena = arena_of(bounded);
  std::vector<Part> parts;
  for (const Solid& solid : bounded) {
    if (!solid.is_mesh) parts.push_back({&solid, 0});
    for (std::uint32_t t = 0; t < solid.triangles.size(); ++t)
      if (has_area(solid, solid.triangles[t])) parts.push_back({&solid, t});
  }
  root = grow(arena.bounds, std::move(parts), 0);
}

// A part goes to every octant that its box touches, so hits may be found twice.
std::unique_ptr<Node> ReferenceTracer::World::grow(const Bounds& box, std::vector<Part> parts,
                                                   int depth) const {
  auto node = std::make_unique<Node>(Node{box, {}, {}});
  if (parts.size() <= 8 || depth == 8) {
    node->parts = std::move(parts);
    return node;
  }
  for (int octant = 0; octant < 8; ++octant) {
    const Bounds child = child_box(box, octant);
    std::vector<Part> inside;
    for (const Part& part : parts)
      if (child.intersects(bounds_of_part(*part.solid, part.triangle))) inside.push_back(part);
    if (!inside.empty()) node->children[octant] = grow(child, std::move(inside), depth + 1);
  }
  return node;
}

void ReferenceTracer::World::test(const Part& part, const Probe& probe,
                                  std::vector<Found>& found) const {
  const Solid& solid = *part.solid;
  if (!solid.is_mesh) {
    if (const auto hit = meet(probe, solid)) found.push_back({hit->distance_m, part, hit});
  } else if (const auto distance_m = meet(probe, solid, solid.triangles[part.triangle])) {
    found.push_back({*distance_m, part, std::nullopt});
  }
}

// Boxes with the arena's margin, which is far above the rounding of doubles.
void ReferenceTracer::World::walk(const Node& node, const Probe& probe,
                                  std::vector<Found>& found) const {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(arena.margin_m);
  Ray line = probe.ray;
  line.min_m = -std::numeric_limits<double>::infinity();
  line.max_m = std::numeric_limits<double>::infinity();
  if (!clip(Bounds(node.box.min() - margin, node.box.max() + margin), line)) return;
  for (const Part& part : node.parts) test(part, probe, found);
  for (const auto& child : node.children)
    if (child) walk(*child, probe, found);
}

std::vector<Found> ReferenceTracer::World::all_hits(const Probe& probe) const {
  std::vector<Found> found;
  for (const Solid& solid : unbounded) test({&solid, 0}, probe, found);
  if (probe.enters) walk(*root, probe, found);
  return found;
}

ReferenceTracer::ReferenceTracer(const Scene& scene) {
  check(scene);
  world_ = std::make_unique<const World>(scene);
}
ReferenceTracer::~ReferenceTracer() = default;

std::optional<Hit> ReferenceTracer::closest(const Ray& ray) const {
  if (!ray.origin.allFinite() || !ray.direction.allFinite()) return std::nullopt;
  Probe probe;
  probe.ray = {ray.origin - world_->origin, ray.direction, ray.min_m, ray.max_m};
  enter(probe, world_->arena);
  std::vector<Found> found = world_->all_hits(probe);
  if (found.empty()) return std::nullopt;
  const auto by_distance = [](const Found& a, const Found& b) {
    return a.distance_m < b.distance_m;
  };
  const double nearest_m = std::min_element(found.begin(), found.end(), by_distance)->distance_m;
  const double same_m = rounding_m(probe.origin_m + nearest_m, world_->arena.size_m);
  std::erase_if(found, [&](const Found& f) { return f.distance_m > nearest_m + same_m; });
  const auto by_name = [](const Found& a, const Found& b) {
    return std::pair(a.part.solid->object, a.part.triangle) <
           std::pair(b.part.solid->object, b.part.triangle);
  };
  const Found& best = *std::min_element(found.begin(), found.end(), by_name);
  probe.solid = best.part.solid;
  probe.triangle = best.part.triangle;
  probe.distance_m = best.distance_m;
  if (best.shape) probe.shape_normal = best.shape->normal;
  if (!best.shape) probe.corners = best.part.solid->triangles[best.part.triangle];
  return answer(probe, ray.origin);
}

bool ReferenceTracer::blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  const double length_m = (to - from).norm();
  if (!(length_m > 0)) return false;
  return closest({from, (to - from) / length_m, 0, length_m}).has_value();
}

}  // namespace scan::synth
