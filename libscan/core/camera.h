// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The pinhole camera with radial and tangential distortion (Brown 1966; OpenCV's five
// coefficients).
#pragma once

#include <Eigen/Core>
#include <optional>

namespace scan {

// Camera frame: x right, y down, z forwards. Pixel centres at whole numbers; (cx, cy) likewise.
struct Camera {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;
  double cy_px = 0;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
};

// Throws scan::Error (input) naming the field if sizes or focal lengths are not positive or a
// number is not finite.
void check(const Camera& camera);

// Pixel of a point in the camera frame (metres); none behind the camera (z <= 0). The pixel may lie
// outside the image.
std::optional<Eigen::Vector2d> project(const Camera& camera, const Eigen::Vector3d& x_in_camera);

// Direction, with z = 1, of the ray through a pixel; inverts the distortion to 1e-12 by Newton
// iteration. None if the iteration finds no inverse (far outside a strongly distorted image).
std::optional<Eigen::Vector3d> ray_through(const Camera& camera, const Eigen::Vector2d& pixel);

}  // namespace scan
