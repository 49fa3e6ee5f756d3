// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the fits of all shapes share: points centred and scaled, and the refusal of a loose problem.
#pragma once

#include <span>

#include <Eigen/Core>

namespace scan {

struct FitPoints {
  Eigen::MatrixX3d points;  // one per row, centroid 0, root mean square length 1
  Eigen::Vector3d centroid_m;
  double scale_m = 0;
};

// Throws scan::Error (computation) naming `shape` for fewer than `least` points, points that
// coincide or are not finite.
FitPoints fit_points(std::span<const Eigen::Vector3d> points, std::size_t least, const char* shape);

// The least-squares solution of a x = b; throws scan::Error (computation) if a combination of the
// columns, each scaled to unit length, is free to rounding.
Eigen::VectorXd fit_step(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, const char* shape);

[[noreturn]] void throw_undetermined(const char* shape);

// Below this ratio of singular values the points leave a parameter of the shape free. Rounding of
// scaled coordinates is 1e-16; a spherical cap of half-angle t has a ratio of about t^2 / 10.
inline constexpr double smallest_fit_ratio = 1e-9;

}  // namespace scan
