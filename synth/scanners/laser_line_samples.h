// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The rays of light into one pixel: over its area, the lens and the time of exposure.
#pragma once

#include <optional>
#include <vector>

#include "synth/scanners/laser_line_optics.h"

namespace scan::synth {

// Depth of sharp images and radius of a point's blur in the image (thin lens).
double lens_focus_m(const LaserLine& scanner);
double blur_radius_px(const LaserLine& scanner, double depth_m);

struct CameraSample {
  Eigen::Vector2d place_px = Eigen::Vector2d::Zero();  // from the pixel's centre
  Eigen::Vector2d lens_m = Eigen::Vector2d::Zero();    // on the lens, from its centre
  double time_steps = 0;  // of the stage, from the middle of the exposure
};

// Of equal weight, and closed under change of sign, so that no mean place, lens point or time is
// off by the choice of samples. A pinhole without motion has the grid of sub_rays; else there are
// n^2 samples, n a prime of 5 or more and not below sub_rays: an orthogonal array, in which any two
// of the five coordinates fill a grid of n x n cells evenly (Bose 1938; Owen 1992), and each of
// lens and time takes n^2 different values (Tang 1993).
std::vector<CameraSample> camera_samples(const LaserLine& scanner);

// The ray of a sample through a pixel: from its point on the lens to where the pixel's ray is
// sharp. None where the distortion has no inverse.
std::optional<CameraRay> camera_ray(const LaserLine& scanner, const Eigen::Vector2d& pixel,
                                    const CameraSample& sample);

}  // namespace scan::synth
