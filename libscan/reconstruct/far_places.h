// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Places far from all samples whose side of a closed surface is beyond doubt.
#pragma once

#include "libscan/reconstruct/samples.h"
#include "libscan/reconstruct/spline_field.h"

namespace scan {

// Farther from any sample than this, of the cube's side, a winding number's groups are points.
inline constexpr double far_distance = 1.0 / 16;

struct FarPlaces {
  std::vector<Eigen::Vector3d> places;  // unit cube
  std::vector<double> distances;        // from the nearest sample; negative inside
};

// Of the centres of the cube's 16^3 cells, farther than far_distance from all samples, those where
// f has the wrong sign by the winding number: f <= 0 where it is 1/4 below that of the surface, f
// >= 0 where it is 1/4 above. None where samples leave out more than a third of the surface as seen
// from itself, or face inward: there nothing is beyond doubt.
FarPlaces misjudged_places(const SplineField& field, const Samples& samples);

}  // namespace scan
