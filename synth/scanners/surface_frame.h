// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How a seen surface answers to light, with directions of the scanner frame.
#pragma once

#include "synth/scanners/first_surface.h"

namespace scan::synth {

class SurfaceFrame {
 public:
  SurfaceFrame(const SeenSurface& seen, const Scene& scene);

  // Electrons towards `out` per electron that a white Lambert surface facing the light would give:
  // pi f(out, in) cos(in). Both unit, away from the surface; 0 from behind.
  double response(const Eigen::Vector3d& out, const Eigen::Vector3d& in) const;

  // The same under uniform light from all sides.
  double albedo(const Eigen::Vector3d& out) const;

 private:
  Eigen::Vector3d local(const Eigen::Vector3d& direction) const;

  Eigen::Matrix3d scanner_from_local_;
  Bsdf bsdf_;
};

}  // namespace scan::synth
