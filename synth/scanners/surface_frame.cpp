// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/surface_frame.h"

#include <cmath>
#include <numbers>

namespace scan::synth {
namespace {

// A right-handed frame whose z axis is `normal` (Duff et al. 2017, "Building an Orthonormal Basis,
// Revisited").
Eigen::Matrix3d frame_about(const Eigen::Vector3d& normal) {
  const double sign = std::copysign(1.0, normal.z());
  const double a = -1 / (sign + normal.z());
  const double b = normal.x() * normal.y() * a;
  Eigen::Matrix3d frame;
  frame.col(0) << 1 + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x();
  frame.col(1) << b, sign + normal.y() * normal.y() * a, -normal.y();
  frame.col(2) = normal;
  return frame;
}

}  // namespace

SurfaceFrame::SurfaceFrame(const SeenSurface& seen, const Scene& scene)
    : scanner_from_local_(frame_about(seen.normal)),
      bsdf_(bsdf_at(scene, seen.hit.object, seen.hit.point)) {}

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
