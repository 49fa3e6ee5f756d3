// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the scanners are measured on and against.
#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "synth/scene.h"

namespace scan::synth {

// A ball of radius 0.35 with bumps, of about `triangles` triangles, 1.2 m before the scanner.
inline Scene bumpy_ball(int triangles) {
  const int rows = std::max(4, static_cast<int>(std::sqrt(triangles / 4.0)));
  const int columns = 2 * rows;
  Mesh mesh;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double polar = std::numbers::pi * i / rows;
      const double around = 2 * std::numbers::pi * j / columns;
      const double r = 0.35 + 0.02 * std::sin(9 * polar) * std::cos(11 * around);
      mesh.vertices.emplace_back(r * std::sin(polar) * std::cos(around), r * std::cos(polar),
                                 1.2 + r * std::sin(polar) * std::sin(around));
    }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>(i * columns + j % columns);
  };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  Object ball;
  ball.name = "ball";
  ball.geometry = std::move(mesh);
  return {.objects = {std::move(ball)}, .materials = {{.name = "matt"}}};
}

// Embree alone over the same triangles.
class RawEmbree {
 public:
  explicit RawEmbree(const Mesh& mesh) : device_(rtcNewDevice(nullptr)) {
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    for (const Eigen::Vector3d& v : mesh.vertices)
      for (int k = 0; k < 3; ++k) *vertices++ = static_cast<float>(v[k]);
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t corner : t) *indices++ = corner;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~RawEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  RawEmbree(const RawEmbree&) = delete;
  RawEmbree& operator=(const RawEmbree&) = delete;

  bool hits(const Eigen::Vector3d& direction) const {
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

 private:
  RTCDevice device_;
  RTCScene scene_ = nullptr;
};

}  // namespace scan::synth
