// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pictures of a surface from six sides, by our own ray caster; no display or GPU needed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "libscan/core/mesh.h"
#include "libscan/io/image_file.h"

namespace scan {

// An orthographic picture and where in it things lie.
struct View {
  std::string name;  // "front (-y)" ...: the side from which it is seen
  Image<Colour> image;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // shown in the middle of the image
  Eigen::Vector3d towards_viewer, right, up;         // unit
  double pixel_m = 1;

  // Column and row, in pixels from the left and upper edge.
  Eigen::Vector2d place(const Eigen::Vector3d& point) const;
};

// A surface coloured by `values` (one per vertex) on the scale [-limit, limit]; NaN is grey; an
// empty list makes it plain clay. Shaded by a light at the viewer. Refers to mesh and values.
class Portrait {
 public:
  Portrait(const Mesh& mesh, const std::vector<double>& values, double limit);
  ~Portrait();

  // Along the six axis directions, each `size_px` square, all at one scale that fits the mesh.
  std::vector<View> six_views(int size_px) const;
  // From the front, the right and above, at a scale of its own.
  View oblique_view(int width_px, int height_px) const;
  // Whether nothing lies before a point of the surface, up to `tolerance_m` around it.
  bool is_seen(const View& view, const Eigen::Vector3d& point, double tolerance_m) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// The scale that holds 99 % of the finite deviations; 1 m for none.
double deviation_limit_m(std::vector<double> deviations_m);

// A disparity image, the truth, and their difference on a scale of +-2 px, side by side. The first
// two run from dark (far) to bright (near) over the truth's range; unknown pixels are blue-grey.
Image<Colour> disparity_sheet(const Image<float>& measured, const Image<float>& truth);

// The views side by side, three in a row.
Image<Colour> contact_sheet(const std::vector<View>& views);

}  // namespace scan
