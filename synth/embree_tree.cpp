// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/embree_tree.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "libscan/core/error.h"
#include "synth/triangle_packet.h"

namespace scan::synth {

constexpr float infinity = std::numeric_limits<float>::infinity();

struct EmbreeTree::Part {
  const Solid* solid = nullptr;
  double margin_m = 0;  // that boxes in floats need
  std::vector<TriangleBlock> blocks;
};

// Embree hands the context through to the callbacks; the rays' ids are their places in `probes`.
struct Callbacks {
  using Part = EmbreeTree::Part;

  RTCIntersectContext embree;  // first: Embree's pointer to it is the pointer to the whole
  Probe* probes;
  const CoarsePacket* packet;  // of a single ray: none

  static const Part& part_of(const void* user_data) { return *static_cast<const Part*>(user_data); }
  static const Callbacks& of(const RTCIntersectContext* context) {
    return *reinterpret_cast<const Callbacks*>(context);
  }

  static void bounds(const RTCBoundsFunctionArguments* call) {
    const Part& part = part_of(call->geometryUserPtr);
    Bounds box = part.solid->bounds;
    if (!part.blocks.empty()) {
      box.setEmpty();
      const TriangleBlock& block = part.blocks[call->primID];
      for (std::uint32_t lane = 0; lane < block.count; ++lane)
        for (const std::uint32_t corner : block.vertices[lane])
          box.extend(part.solid->vertices[corner]);
    }
    const Eigen::Vector3f low = (box.min().array() - part.margin_m).matrix().cast<float>();
    const Eigen::Vector3f high = (box.max().array() + part.margin_m).matrix().cast<float>();
    *call->bounds_o = {low.x(), low.y(), low.z(), 0, high.x(), high.y(), high.z(), 0};
  }

  // Where the float ray may end; its rounding is covered by the boxes' margin.
  static float limit(const Probe& probe) {
    return static_cast<float>(probe.nearest_m - probe.start_m);
  }

  // What a ray finds of a part: takes the hit into account, or says that there is one.
  static void find(const Part& part, const TriangleBlock& block, int lane, Probe& probe,
                   float& far_m) {
    const auto distance_m = meet(probe, *part.solid, block.vertices[lane]);
    if (!distance_m) return;
    offer(probe, *part.solid, block.triangle[lane], block.vertices[lane], *distance_m);
    far_m = std::min(far_m, limit(probe));
  }
  static void find(const Part& part, Probe& probe, float& far_m) {
    const auto hit = meet(probe, *part.solid);
    if (!hit) return;
    offer(probe, *part.solid, *hit);
    far_m = std::min(far_m, limit(probe));
  }
  static void find_any(const Part& part, const TriangleBlock& block, int lane, Probe& probe,
                       float& far_m) {
    if (meet(probe, *part.solid, block.vertices[lane])) far_m = -infinity;
  }
  static void find_any(const Part& part, Probe& probe, float& far_m) {
    if (meet(probe, *part.solid)) far_m = -infinity;
  }

  // find(lane, probe, far_m) for the triangles that the block proposes to the packet's rays.
  template <class Find>
  static void packet_in_block(const Callbacks& self, const TriangleBlock& block, const int* valid,
                              RTCRayN* rays, unsigned count, Find&& find) {
    const unsigned first = RTCRayN_id(rays, count, 0);
    unsigned rays_of[TriangleBlock::lanes];
    float* const far_m = &RTCRayN_tfar(rays, count, 0);
    candidates(block, *self.packet, first, count, &RTCRayN_tnear(rays, count, 0), far_m, rays_of);
    for (int lane = 0; lane < static_cast<int>(TriangleBlock::lanes); ++lane)
      for (unsigned left = rays_of[lane]; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        if (valid[i] && far_m[i] >= 0) find(lane, self.probes[first + i], far_m[i]);
      }
  }

  template <class Find>
  static void ray_in_block(const TriangleBlock& block, Probe& probe, float near_m, float& far_m,
                           Find&& find) {
    for (unsigned left = candidates(block, probe.coarse_ray, near_m, far_m);
         left != 0 && far_m >= 0; left &= left - 1)
      find(std::countr_zero(left), probe, far_m);
  }

  template <class FindTriangle, class FindShape>
  static void visit(const Part& part, const Callbacks& self, unsigned index, const int* valid,
                    RTCRayN* rays, unsigned count, FindTriangle&& find_triangle,
                    FindShape&& find_shape) {
    const bool shape = part.blocks.empty();
    if (!shape && count > 1 && !self.packet->mixed)
      return packet_in_block(self, part.blocks[index], valid, rays, count, find_triangle);
    for (unsigned i = 0; i < count; ++i) {
      if (!valid[i]) continue;
      Probe& probe = self.probes[RTCRayN_id(rays, count, i)];
      float& far_m = RTCRayN_tfar(rays, count, i);
      if (shape)
        find_shape(probe, far_m);
      else
        ray_in_block(part.blocks[index], probe, RTCRayN_tnear(rays, count, i), far_m,
                     find_triangle);
    }
  }

  static void closest(const RTCIntersectFunctionNArguments* call) {
    const Part& part = part_of(call->geometryUserPtr);
    visit(
        part, of(call->context), call->primID, call->valid, RTCRayHitN_RayN(call->rayhit, call->N),
        call->N,
        [&](int lane, Probe& probe, float& far_m) {
          find(part, part.blocks[call->primID], lane, probe, far_m);
        },
        [&](Probe& probe, float& far_m) { find(part, probe, far_m); });
  }

  static void any(const RTCOccludedFunctionNArguments* call) {
    const Part& part = part_of(call->geometryUserPtr);
    visit(
        part, of(call->context), call->primID, call->valid, call->ray, call->N,
        [&](int lane, Probe& probe, float& far_m) {
          find_any(part, part.blocks[call->primID], lane, probe, far_m);
        },
        [&](Probe& probe, float& far_m) { find_any(part, probe, far_m); });
  }
};

namespace {

Callbacks context_for(Probe* probes, const CoarsePacket* packet, RTCIntersectContextFlags flags) {
  Callbacks context;
  rtcInitIntersectContext(&context.embree);
  context.embree.flags = flags;
  context.probes = probes;
  context.packet = packet;
  return context;
}

// The ray's part inside the tree, rounded.
RTCRay rounded(const Probe& probe, unsigned id) {
  const CoarseRay& from = probe.coarse_ray;
  const Eigen::Vector3f along = probe.ray.direction.cast<float>();
  RTCRay ray{};
  ray.org_x = from.origin[0];
  ray.org_y = from.origin[1];
  ray.org_z = from.origin[2];
  ray.dir_x = along.x();
  ray.dir_y = along.y();
  ray.dir_z = along.z();
  // tnear stays 0: in coherent packets Embree loses hits that begin just beyond it.
  ray.tfar = static_cast<float>(std::min(probe.ray.max_m, probe.nearest_m) - probe.start_m);
  ray.mask = ~0u;
  ray.id = id;
  return ray;
}

void put(RTCRay16& packet, std::size_t i, const RTCRay& ray) {
  packet.org_x[i] = ray.org_x;
  packet.org_y[i] = ray.org_y;
  packet.org_z[i] = ray.org_z;
  packet.tnear[i] = ray.tnear;
  packet.dir_x[i] = ray.dir_x;
  packet.dir_y[i] = ray.dir_y;
  packet.dir_z[i] = ray.dir_z;
  packet.time[i] = 0;
  packet.tfar[i] = ray.tfar;
  packet.mask[i] = ray.mask;
  packet.id[i] = ray.id;
  packet.flags[i] = 0;
}

// Blocks of all triangles with area; the solid's own list of triangles is given up for them.
std::vector<TriangleBlock> take_blocks(Solid& solid) {
  std::vector<std::uint32_t> which;
  which.reserve(solid.triangles.size());
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t)
    if (has_area(solid, solid.triangles[t])) which.push_back(t);
  const std::vector<Triangle> triangles = std::exchange(solid.triangles, {});
  return make_blocks(solid.vertices, triangles, which);
}

}  // namespace

EmbreeTree::EmbreeTree() = default;

void EmbreeTree::build(std::vector<Solid> solids) {
  solids_ = std::move(solids);
  arena_ = arena_of(solids_);
  parts_.reserve(solids_.size());
  for (Solid& solid : solids_) {
    Part part{.solid = &solid, .margin_m = arena_.margin_m, .blocks = {}};
    if (solid.is_mesh) {
      part.blocks = take_blocks(solid);
      if (part.blocks.empty()) continue;
    }
    parts_.push_back(std::move(part));
  }
  commit();
}

EmbreeTree::~EmbreeTree() {
  if (scene_) rtcReleaseScene(scene_);
  if (device_) rtcReleaseDevice(device_);
}

void EmbreeTree::commit() {
  device_ = rtcNewDevice(nullptr);
  if (!device_) throw Error(Trouble::computation, "ray caster: Embree gives no device");
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
  for (Part& part : parts_) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    const std::size_t primitives = std::max<std::size_t>(1, part.blocks.size());
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(primitives));
    rtcSetGeometryUserData(geometry, &part);
    rtcSetGeometryBoundsFunction(geometry, Callbacks::bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, Callbacks::closest);
    rtcSetGeometryOccludedFunction(geometry, Callbacks::any);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device_) == RTC_ERROR_NONE) return;
  throw Error(Trouble::resource, "ray caster: Embree cannot build its tree");
}

void EmbreeTree::offer_hits(Probe& probe) const {
  if (!scene_ || !probe.enters) return;
  Callbacks context = context_for(&probe, nullptr, RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  RTCRayHit query{};
  query.ray = rounded(probe, 0);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_, &context.embree, &query);
}

bool EmbreeTree::any_hit(Probe& probe) const {
  if (!scene_ || !probe.enters) return false;
  Callbacks context = context_for(&probe, nullptr, RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  RTCRay ray = rounded(probe, 0);
  rtcOccluded1(scene_, &context.embree, &ray);
  return ray.tfar < 0;
}

void EmbreeTree::offer_hits(std::span<Probe> probes, std::span<const bool> wanted) const {
  if (!scene_) return;
  CoarsePacket coarse;
  Callbacks context = context_for(probes.data(), &coarse, RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  alignas(64) int valid[packet] = {};
  RTCRayHit16 query;
  std::iota(query.ray.id, query.ray.id + packet, 0U);
  for (std::size_t i = 0; i < probes.size(); ++i) {
    if (!(wanted[i] && probes[i].enters)) continue;
    valid[i] = -1;
    put(coarse, static_cast<unsigned>(i), probes[i].coarse_ray);
    put(query.ray, i, rounded(probes[i], static_cast<unsigned>(i)));
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect16(valid, scene_, &context.embree, &query);
}

void EmbreeTree::any_hit(std::span<Probe> probes, std::span<const bool> wanted,
                         std::span<bool> found) const {
  if (!scene_) return;
  CoarsePacket coarse;
  Callbacks context = context_for(probes.data(), &coarse, RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  alignas(64) int valid[packet] = {};
  RTCRay16 query;
  std::iota(query.id, query.id + packet, 0U);
  for (std::size_t i = 0; i < probes.size(); ++i) {
    if (!(wanted[i] && probes[i].enters)) continue;
    valid[i] = -1;
    put(coarse, static_cast<unsigned>(i), probes[i].coarse_ray);
    put(query, i, rounded(probes[i], static_cast<unsigned>(i)));
  }
  rtcOccluded16(valid, scene_, &context.embree, &query);
  for (std::size_t i = 0; i < probes.size(); ++i) found[i] |= valid[i] && query.tfar[i] < 0;
}

}  // namespace scan::synth
