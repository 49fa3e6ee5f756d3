// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pictures of a surface from six sides, by our own ray caster; no display or GPU needed.
#pragma once

#include <string>
#include <vector>

#include "libscan/core/mesh.h"
#include "libscan/io/image_file.h"

namespace scan {

struct View {
  std::string name;  // "front (-y)" ...: the side from which it is seen
  Image<Colour> image;
};

// Orthographic views along the six axis directions, each `size_px` square, all at one scale that
// fits the mesh. `values` (one per vertex) colour the surface on the scale [-limit, limit]; NaN is
// grey; an empty list draws plain clay. Shaded by a light at the viewer.
std::vector<View> six_views(const Mesh& mesh, const std::vector<double>& values, double limit,
                            int size_px);

// The scale that holds 99 % of the finite deviations; 1 m for none.
double deviation_limit_m(std::vector<double> deviations_m);

// A disparity image, the truth, and their difference on a scale of +-2 px, side by side. The first
// two run from dark (far) to bright (near) over the truth's range; unknown pixels are blue-grey.
Image<Colour> disparity_sheet(const Image<float>& measured, const Image<float>& truth);

// The views side by side, three in a row.
Image<Colour> contact_sheet(const std::vector<View>& views);

}  // namespace scan
