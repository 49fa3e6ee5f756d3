// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Embree as it comes, beside which the ray caster and the scanners are measured.
#pragma once

#include <embree3/rtcore.h>

#include <span>

#include "libscan/core/mesh.h"
#include "synth/shape_rays.h"

namespace scan::synth {

struct Segment {
  Eigen::Vector3d from, to;
};

// Native triangles without any care but Embree's own.
class RawEmbree {
 public:
  explicit RawEmbree(const Mesh& mesh);
  RawEmbree(const RawEmbree&) = delete;
  RawEmbree& operator=(const RawEmbree&) = delete;
  ~RawEmbree();

  // From the origin.
  bool hits(const Eigen::Vector3d& direction) const;
  // Sum of the distances of all hits.
  double closest(std::span<const Ray> rays) const;
  double closest_in_packets(std::span<const Ray> rays, bool coherent) const;
  // How many segments are blocked.
  double shadows(std::span<const Segment> segments) const;
  double shadows_in_packets(std::span<const Segment> segments, bool coherent) const;

 private:
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace scan::synth
