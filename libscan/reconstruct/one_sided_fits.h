// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The smooth pieces that meet at a sharp edge or corner, each fitted to its own samples alone.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "libscan/search/kd_tree.h"

namespace scan {

// A height of second order over a plane: exact on planes, to third order on any smooth surface.
struct QuadricPatch {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  // rows: two directions in the plane, normal
  std::array<double, 6> height{};                       // of 1, u, v, u^2, uv, v^2
  // Signed distance to first order, and its gradient; positive on the normal's side.
  double distance(const Eigen::Vector3d& x) const;
  Eigen::Vector3d normal(const Eigen::Vector3d& x) const;
};

// How the pieces' solids make one: all intersected (a convex edge), all united (a concave one), or
// the first two by one of these and the third by the other (a saddle corner).
struct SharpSurface {
  std::array<QuadricPatch, 3> pieces;
  int count = 0;
  bool first_two_intersect = true;
  bool third_intersects = true;

  struct Active {
    double distance = 0;
    int piece = 0;
  };
  Active at(const Eigen::Vector3d& x) const;
  // The place on the surface below x, by steps along the active piece's normal.
  Eigen::Vector3d onto(Eigen::Vector3d x) const;
  // The piece whose normal at x is nearest to `normal`.
  int piece_like(const Eigen::Vector3d& normal, const Eigen::Vector3d& x) const;
  // The nearest place where the named pieces meet, from x, by Newton steps.
  Eigen::Vector3d meeting_place(std::span<const int> named, Eigen::Vector3d x) const;
};

// Samples with unit normals and the spacing about each. Keeps references.
class OneSidedFits {
 public:
  OneSidedFits(std::span<const Eigen::Vector3d> points, std::span<const Eigen::Vector3d> normals,
               std::span<const double> spacing);
  double spacing_at(const Eigen::Vector3d& x) const;
  // The surface about x if it has a sharp feature within 3.5 spacings: two or three groups of
  // normals, 30 degrees or more apart and six times their own scatter, each on a quadric to within
  // a tenth of a spacing and on one side of the others. Else count is 0.
  SharpSurface about(const Eigen::Vector3d& x) const;

 private:
  std::span<const Eigen::Vector3d> points_, normals_;
  std::span<const double> spacing_;
  KdTree tree_;
};

}  // namespace scan
