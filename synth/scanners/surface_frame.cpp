// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/surface_frame.h"

#include <numbers>

#include "synth/frame_about.h"

namespace scan::synth {

SurfaceFrame::SurfaceFrame(const SeenSurface& seen, const Scene& scene)
    : scanner_from_local_(frame_about(seen.normal)),
      bsdf_(bsdf_at(scene, seen.hit.object, seen.hit.triangle, seen.hit.point)) {}

Eigen::Vector3d SurfaceFrame::local(const Eigen::Vector3d& direction) const {
  return scanner_from_local_.transpose() * direction;
}

double SurfaceFrame::response(const Eigen::Vector3d& out, const Eigen::Vector3d& in) const {
  const Eigen::Vector3d in_local = local(in);
  if (!(in_local.z() > 0)) return 0;
  return std::numbers::pi * evaluate(bsdf_, local(out), in_local) * in_local.z();
}

double SurfaceFrame::albedo(const Eigen::Vector3d& out) const {
  return synth::albedo(bsdf_, local(out));
}

}  // namespace scan::synth
