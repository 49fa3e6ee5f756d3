// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/raw_embree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace scan::synth {
namespace {

std::array<int, 16> all_valid() {
  std::array<int, 16> valid;
  valid.fill(-1);
  return valid;
}

void set(RTCRay16& packet, std::size_t k, const Eigen::Vector3d& origin,
         const Eigen::Vector3d& direction, float end) {
  packet.org_x[k] = static_cast<float>(origin.x());
  packet.org_y[k] = static_cast<float>(origin.y());
  packet.org_z[k] = static_cast<float>(origin.z());
  packet.dir_x[k] = static_cast<float>(direction.x());
  packet.dir_y[k] = static_cast<float>(direction.y());
  packet.dir_z[k] = static_cast<float>(direction.z());
  packet.tfar[k] = end;
  packet.mask[k] = ~0U;
}

}  // namespace

RawEmbree::RawEmbree(const Mesh& mesh)
    : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.vertices.size()));
  for (const auto& v : mesh.vertices)
    for (const double x : v) *vertices++ = static_cast<float>(x);
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) indices = std::copy(t.begin(), t.end(), indices);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
}

RawEmbree::~RawEmbree() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

bool RawEmbree::hits(const Eigen::Vector3d& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray{};
  ray.ray.dir_x = static_cast<float>(direction.x());
  ray.ray.dir_y = static_cast<float>(direction.y());
  ray.ray.dir_z = static_cast<float>(direction.z());
  ray.ray.tfar = INFINITY;
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_, &context, &ray);
  return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

double RawEmbree::closest(std::span<const Ray> rays) const {
  double sum = 0;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (const Ray& from : rays) {
    RTCRayHit ray{};
    ray.ray = {static_cast<float>(from.origin.x()),
               static_cast<float>(from.origin.y()),
               static_cast<float>(from.origin.z()),
               0,
               static_cast<float>(from.direction.x()),
               static_cast<float>(from.direction.y()),
               static_cast<float>(from.direction.z()),
               0,
               1e30F,
               ~0U,
               0,
               0};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &ray);
    if (ray.hit.geomID != RTC_INVALID_GEOMETRY_ID) sum += ray.ray.tfar;
  }
  return sum;
}

double RawEmbree::closest_in_packets(std::span<const Ray> rays, bool coherent) const {
  double sum = 0;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) const auto valid = all_valid();
  for (std::size_t i = 0; i + 16 <= rays.size(); i += 16) {
    RTCRayHit16 packet{};
    for (std::size_t k = 0; k < 16; ++k) {
      set(packet.ray, k, rays[i + k].origin, rays[i + k].direction, 1e30F);
      packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid.data(), scene_, &context, &packet);
    for (std::size_t k = 0; k < 16; ++k)
      if (packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID) sum += packet.ray.tfar[k];
  }
  return sum;
}

double RawEmbree::shadows(std::span<const Segment> segments) const {
  double count = 0;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (const Segment& s : segments) {
    const Eigen::Vector3f from = s.from.cast<float>(), along = (s.to - s.from).cast<float>();
    RTCRay ray{from.x(),  from.y(), from.z(), 1e-5F, along.x(), along.y(),
               along.z(), 0,        1,        ~0U,   0,         0};
    rtcOccluded1(scene_, &context, &ray);
    count += ray.tfar < 0;
  }
  return count;
}

double RawEmbree::shadows_in_packets(std::span<const Segment> segments, bool coherent) const {
  double count = 0;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) const auto valid = all_valid();
  for (std::size_t i = 0; i + 16 <= segments.size(); i += 16) {
    RTCRay16 packet{};
    for (std::size_t k = 0; k < 16; ++k) {
      const Segment& s = segments[i + k];
      set(packet, k, s.from, s.to - s.from, 1);
      packet.tnear[k] = 1e-5F;
    }
    rtcOccluded16(valid.data(), scene_, &context, &packet);
    for (const float end : packet.tfar) count += end < 0;
  }
  return count;
}

}  // namespace scan::synth
