// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Distances along a ray, spread as a light beside it is seen: in equal angles.
#pragma once

#include "synth/transport/emitter.h"

namespace scan::synth {

// Brightest by a point light; one on the ray counts as a tenth of a millimetre beside it.
Brightest nearest_to(const Eigen::Vector3d& light, const Eigen::Vector3d& origin,
                     const Eigen::Vector3d& direction);

// Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating Media":
// density in proportion to 1 / (w^2 + (t - t0)^2), Cauchy's with the brightest place t0 and half
// width w, cut to distances from 0 to an end that may be infinite. For a point light, w beside the
// ray, that is one over the squared distance.
class Equiangular {
 public:
  Equiangular(const Brightest& brightest, double end_m);

  double sample(double u) const;            // distance for u in [0, 1)
  double density(double distance_m) const;  // per m

 private:
  Brightest brightest_;
  double begin_rad_, angle_rad_;
};

}  // namespace scan::synth
