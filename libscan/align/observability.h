// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which motions of an alignment the data fix, and which only seem to be fixed by noise.
//
// A surface fixes a small motion v = (rotation, translation / size) by the distance over which it
// carries points out of their planes: v^T A v, A the sum of J^T J with J = (p x n, n), p about the
// centre and in units of `size`. Normals that are off by d give v^T N v more with J = (p x d, d),
// although nothing is fixed. N is measured: d is a draw of the normal's error, from the two halves
// of a point's neighbours, or from two scans of the same place. A motion is weak when v^T A v <
// 4 v^T N v: then noise could account for a quarter or more of the apparent information.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libscan/align/local_surface.h"
#include "libscan/core/pose.h"

namespace scan {

using TwistBasis = Eigen::Matrix<double, 6, Eigen::Dynamic>;

// Centre and size (root mean square distance from it) of the part of the data in use, metres.
struct DataFrame {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double size_m = 1;
};

// Sums over points, arms from the frame's centre in units of its size.
class MotionInformation {
 public:
  // A plane of this normal; `error`: a draw of the normal's error, if there is one.
  void add_plane(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal,
                 const std::optional<Eigen::Vector3d>& error);
  // A mark that fixes the coordinates along the columns of `projector`.
  void add_mark(const Eigen::Vector3d& arm, const Eigen::Matrix3d& projector);

  MotionInformation& operator+=(const MotionInformation& other);

  const Matrix6& apparent() const { return apparent_; }
  // For all planes, from those whose error was drawn.
  Matrix6 noise() const;

 private:
  Matrix6 apparent_ = Matrix6::Zero();
  Matrix6 noise_ = Matrix6::Zero();
  double planes_ = 0, drawn_ = 0;
};

// Orthonormal basis of the weak motions, as twists about the frame's centre with the translation in
// units of its size; no columns: none is weak.
TwistBasis weak_motions(const MotionInformation& information);

// The same at the points `used` (indices into `points`, may repeat). `normals` has one per point;
// with none the fits stand in; where most points have no surface around them, these count as marks
// that fix all three coordinates.
TwistBasis weak_motions(std::span<const std::uint32_t> used,
                        std::span<const Eigen::Vector3d> points,
                        std::span<const Eigen::Vector3d> normals, std::span<const LocalFit> fits,
                        const DataFrame& frame);

// The same motions about another frame, orthonormal there.
TwistBasis carried(const TwistBasis& motions, const DataFrame& from, const DataFrame& to);

// Names of weak motions: "slide along (x, y, z)", "turn about (x, y, z) through (x, y, z) m", or
// "screw about ... by ... m per turn". `origin` is added to every position.
std::vector<std::string> name_motions(const TwistBasis& motions, const DataFrame& frame,
                                      const Eigen::Vector3d& origin);

// Solution of A x = b in least squares within the complement of `withheld`; motions that A does not
// hold to rounding get none.
Vector6 solve_withholding(const Matrix6& a, const Vector6& b, const TwistBasis& withheld);

// I - W W^T.
Matrix6 complement_projector(const TwistBasis& withheld);

}  // namespace scan
