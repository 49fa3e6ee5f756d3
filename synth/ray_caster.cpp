// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/ray_caster.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "libscan/core/error.h"
#include "synth/solid.h"

namespace scan::synth {
namespace {

constexpr float float_epsilon = std::numeric_limits<float>::epsilon();

// One question to the tree. Embree hands it through to the callbacks, which work on it in double.
struct Query {
  RTCIntersectContext embree;  // first: Embree's pointer to it is the pointer to the query
  Ray ray;                     // scene frame
  ShearedRay sheared_ray;
  double tree_start_m = 0;  // where the float ray starts along the double one
  SolidHit best;

  // Takes a hit that is nearer or, at the same distance to rounding, of a lower object or triangle.
  void offer(const SolidHit& hit, double same_m) {
    const double gap = hit.distance_m - best.distance_m;
    const bool lower = std::pair(hit.object, hit.triangle) < std::pair(best.object, best.triangle);
    if (std::abs(gap) <= same_m ? lower : gap < 0) best = hit;
  }

  // Where the float ray may end; its rounding is covered by the boxes' margin.
  float tree_limit() const { return static_cast<float>(best.distance_m - tree_start_m); }
};

const Solid& solid_of(const void* user_data) {
  return *static_cast<const Solid*>(user_data);
}

void bounds_callback(const RTCBoundsFunctionArguments* call) {
  const Solid& solid = solid_of(call->geometryUserPtr);
  Bounds box = solid.bounds;
  if (!solid.triangles.empty()) {
    const auto [i, j, k] = solid.triangles[call->primID];
    box = Bounds(solid.vertices[i]);
    box.extend(solid.vertices[j]);
    box.extend(solid.vertices[k]);
  }
  const Eigen::Vector3f low = (box.min().array() - solid.margin_m).matrix().cast<float>();
  const Eigen::Vector3f high = (box.max().array() + solid.margin_m).matrix().cast<float>();
  *call->bounds_o = {low.x(), low.y(), low.z(), 0, high.x(), high.y(), high.z(), 0};
}

void intersect_callback(const RTCIntersectFunctionNArguments* call) {
  if (!call->valid[0]) return;
  auto& query = *reinterpret_cast<Query*>(call->context);
  const Solid& solid = solid_of(call->geometryUserPtr);
  const auto hit = meet(solid, call->primID, query.ray, query.sheared_ray);
  if (!hit) return;
  query.offer(*hit, rounding_m(solid, query.ray, hit->distance_m));
  float& tfar = reinterpret_cast<RTCRayHit*>(call->rayhit)->ray.tfar;
  tfar = std::min(tfar, query.tree_limit());
}

void occluded_callback(const RTCOccludedFunctionNArguments* call) {
  if (!call->valid[0]) return;
  const auto& query = *reinterpret_cast<const Query*>(call->context);
  if (meet(solid_of(call->geometryUserPtr), call->primID, query.ray, query.sheared_ray))
    reinterpret_cast<RTCRay*>(call->ray)->tfar = -std::numeric_limits<float>::infinity();
}

}  // namespace

struct RayCaster::Device {
  explicit Device(const Scene& described);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  std::optional<SolidHit> closest(Query& query) const;
  bool any(Query& query) const;

  Scene scene;
  Eigen::Vector3d origin;  // of the scene frame
  Bounds bounds;           // of the solids in the tree with their margins, scene frame
  std::vector<Solid> in_tree;
  std::vector<Solid> unbounded;  // tested one by one
  std::vector<double> size_m;    // per object, 0 for an unbounded one
  RTCDevice embree = nullptr;
  RTCScene tree = nullptr;

 private:
  void build();
  std::optional<RTCRay> enter_tree(Query& query) const;
};

RayCaster::Device::Device(const Scene& described) : scene(described), origin(scene_origin(scene)) {
  for (int i = 0; i < static_cast<int>(scene.objects.size()); ++i) {
    Solid solid = make_solid(scene, i, origin);
    size_m.push_back(solid.size_m);
    if (solid.bounds.isEmpty()) continue;
    if (is_finite(solid.bounds)) bounds.extend(solid.bounds);
    (is_finite(solid.bounds) ? in_tree : unbounded).push_back(std::move(solid));
  }
  if (in_tree.empty()) return;
  // The float ray starts where the double ray enters the bounds, so start, direction and box are
  // each off by float rounding of the bounds' size at most; 16 covers their sum.
  const double margin_m = 16 * float_epsilon * bounds.diagonal().norm();
  for (Solid& solid : in_tree) solid.margin_m = margin_m;
  bounds = Bounds(bounds.min() - Eigen::Vector3d::Constant(margin_m),
                  bounds.max() + Eigen::Vector3d::Constant(margin_m));
  build();
}

RayCaster::Device::~Device() {
  if (tree) rtcReleaseScene(tree);
  if (embree) rtcReleaseDevice(embree);
}

void RayCaster::Device::build() {
  embree = rtcNewDevice(nullptr);
  if (!embree) throw Error(Trouble::computation, "ray caster: Embree gives no device");
  tree = rtcNewScene(embree);
  rtcSetSceneFlags(tree, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(tree, RTC_BUILD_QUALITY_MEDIUM);
  for (Solid& solid : in_tree) {
    RTCGeometry geometry = rtcNewGeometry(embree, RTC_GEOMETRY_TYPE_USER);
    const std::size_t primitives = std::max<std::size_t>(1, solid.triangles.size());
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(primitives));
    rtcSetGeometryUserData(geometry, &solid);
    rtcSetGeometryBoundsFunction(geometry, bounds_callback, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_callback);
    rtcSetGeometryOccludedFunction(geometry, occluded_callback);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(tree);
  if (rtcGetDeviceError(embree) == RTC_ERROR_NONE) return;
  rtcReleaseScene(tree);
  rtcReleaseDevice(embree);
  throw Error(Trouble::resource, "ray caster: Embree cannot build its tree");
}

// The part of the query's ray that crosses the tree's bounds, in floats.
std::optional<RTCRay> RayCaster::Device::enter_tree(Query& query) const {
  if (!tree) return std::nullopt;
  const auto span = clip(bounds, query.ray);
  if (!span) return std::nullopt;
  query.tree_start_m = span->enter_m;
  query.sheared_ray = sheared(query.ray.origin, query.ray.direction);
  rtcInitIntersectContext(&query.embree);
  const Eigen::Vector3f start =
      (query.ray.origin + span->enter_m * query.ray.direction).cast<float>();
  const Eigen::Vector3f direction = query.ray.direction.cast<float>();
  RTCRay ray{};
  ray.org_x = start.x();
  ray.org_y = start.y();
  ray.org_z = start.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tfar = static_cast<float>(span->leave_m - span->enter_m);
  ray.mask = ~0u;
  return ray;
}

std::optional<SolidHit> RayCaster::Device::closest(Query& query) const {
  for (const Solid& solid : unbounded)
    if (const auto hit = meet(solid, 0, query.ray, query.sheared_ray))
      query.offer(*hit, rounding_m(solid, query.ray, hit->distance_m));
  if (const auto ray = enter_tree(query)) {
    RTCRayHit rayhit{};
    rayhit.ray = *ray;
    rayhit.ray.tfar = std::min(ray->tfar, query.tree_limit());
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(tree, &query.embree, &rayhit);
  }
  if (query.best.object < 0) return std::nullopt;
  return query.best;
}

bool RayCaster::Device::any(Query& query) const {
  for (const Solid& solid : unbounded)
    if (meet(solid, 0, query.ray, query.sheared_ray)) return true;
  auto ray = enter_tree(query);
  if (!ray) return false;
  rtcOccluded1(tree, &query.embree, &*ray);
  return ray->tfar < 0;
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
  if (!origin.allFinite() || !direction.allFinite()) return std::nullopt;
  Query query{};
  query.ray = {origin - device_->origin, direction, min_m, max_m};
  const auto hit = device_->closest(query);
  if (!hit) return std::nullopt;
  return Hit{hit->distance_m, origin + hit->distance_m * direction, hit->normal.normalized(),
             hit->object, hit->triangle};
}

bool RayCaster::occluded(const Hit& hit, const Eigen::Vector3d& light) const {
  if (!(hit.normal.dot(light - hit.point) > 0)) return true;
  return blocked(leave(hit, hit.normal), light);
}

Eigen::Vector3d RayCaster::leave(const Hit& hit, const Eigen::Vector3d& direction) const {
  const double size_m = hit.object >= 0 ? device_->size_m[hit.object] : 0;
  const double scale_m = hit.point.norm() + device_->origin.norm() + hit.distance_m + size_m;
  const double offset_m = 128 * std::numeric_limits<double>::epsilon() * scale_m;
  return hit.point + std::copysign(offset_m, hit.normal.dot(direction)) * hit.normal;
}

bool RayCaster::blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  const double length_m = (to - from).norm();
  // what stands within the rounding of the end is the end's own surface
  const double margin_m = 128 * std::numeric_limits<double>::epsilon() *
                          (from.norm() + to.norm() + device_->origin.norm());
  if (!(length_m > margin_m)) return false;
  Query query{};
  query.ray = {from - device_->origin, (to - from) / length_m, 0, length_m - margin_m};
  return device_->any(query);
}

}  // namespace scan::synth
