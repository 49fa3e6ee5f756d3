// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A scanner's errors on calibrated bodies, as acceptance tests for optical scanners define them.
//
// The quantities follow VDI/VDE 2634 parts 2 and 3 and ISO 10360-13: Gauss fits, form as the range
// of the residuals after leaving out at most 0.3 % of the points. The range grows with the number
// of points, so the width that holds 95 % stands beside it. Points are in metres in one frame per
// place. All throw scan::Error: (input) for no place; what the fits throw.
#pragma once

#include <span>
#include <vector>

#include "libscan/verify/fit.h"
#include "libscan/verify/verdict.h"

namespace scan {

using Points = std::vector<Eigen::Vector3d>;

struct Form {
  double range_m = 0;     // largest less smallest residual, 0.3 % of the points left out
  double width_95_m = 0;  // narrowest interval that holds 95 % of them
};
// Of the residuals of a fit. The points left out are those farthest from the middle of the list.
Form form_of(std::span<const double> residuals_m);

// Indices of the residuals without the 0.3 % that are farthest from their median.
std::vector<std::size_t> without_outliers(std::span<const double> residuals_m);

// One ball at several places. probing_form and probing_form_95 (largest over the places), and
// probing_size: fitted less true diameter, the one farthest from 0.
std::vector<Measurement> probing_errors(std::span<const Points> balls, double true_diameter_m);

// Two balls on a bar at several places. sphere_spacing_error: distance of the fitted centres less
// the true one, the one farthest from 0.
struct BallBar {
  Points first, second;
};
std::vector<Measurement> spacing_errors(std::span<const BallBar> bars, double true_length_m);

// One plate at several places. flatness and flatness_95: as the form, of the residuals to the
// plane.
std::vector<Measurement> flatness_errors(std::span<const Points> plates);

// One cylinder at several places. cylinder_diameter_error, cylindricity, cylindricity_95 and
// cylinder_axis_error (angle to the true axis, rad).
struct CylinderPlace {
  Points points;
  Axis true_axis;
};
std::vector<Measurement> cylinder_errors(std::span<const CylinderPlace> places,
                                         double true_diameter_m);

// Two parallel faces at several places. step_error: distance of the upper face's centroid from the
// plane of the lower less the true height, the one farthest from 0.
struct Step {
  Points lower, upper;
};
std::vector<Measurement> step_errors(std::span<const Step> steps, double true_height_m);

// Balls at known centres, each as seen from the same scanner. length_error: distance of two fitted
// centres less the true one, of all pairs the one farthest from 0 (VDI/VDE 2634 part 1; for
// time-of-flight scanners the point-to-point distance of ASTM E3125).
struct PlacedBall {
  Points points;
  Eigen::Vector3d true_centre;
};
std::vector<Measurement> length_errors(std::span<const PlacedBall> balls);

// Plates one behind the other on a line. relative_range_error: how much farther than in truth a
// plate stands behind the first, along the line, the one farthest from 0 (ASTM E2938).
struct PlacedPlate {
  Points points;
  Eigen::Vector3d true_point;  // where the line meets its face
};
std::vector<Measurement> relative_range_errors(std::span<const PlacedPlate> plates,
                                               const Eigen::Vector3d& line);

// Of the same figure measured several times: <name>_repeatability, its standard deviation. Throws
// scan::Error (input) for fewer than two values.
Measurement repeatability(const Measurement& figure, std::span<const double> values);

}  // namespace scan
