// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a pair of points contributes to an alignment: its residual and how a small motion changes
// it.
//
// The motion is a left perturbation about `centre` (a point near the data, so that far coordinates
// cost no digits): x -> centre + exp(twist) (x - centre), twist = (rotation rad, translation m).
// To add a residual: 1. a struct with `dimension`, `value` and `jacobian` as below; 2. its line in
// residual_test.cpp, which checks the derivative, the zero set and the independence of the frame.
#pragma once

#include <Eigen/Core>

namespace scan {

// A source point carried into the target's frame, its partner, the partner's unit normal and the
// source's own, carried along.
struct PointPair {
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d moved_normal = Eigen::Vector3d::Zero();
};

// r = moved - target, metres (Besl and McKay 1992).
struct PointToPoint {
  static constexpr int dimension = 3;
  static Eigen::Vector3d value(const PointPair& pair);
  static Eigen::Matrix<double, 3, 6> jacobian(const PointPair& pair, const Eigen::Vector3d& centre);
};

// r = n . (moved - target), metres (Chen and Medioni 1992): the whole dot product, so a motion
// within the plane costs nothing.
struct PointToPlane {
  static constexpr int dimension = 1;
  static double value(const PointPair& pair);
  static Eigen::Matrix<double, 1, 6> jacobian(const PointPair& pair, const Eigen::Vector3d& centre);
};

// r = (n + m) / 2 . (moved - target), metres, m the source's normal turned to n's side
// (Rusinkiewicz 2019, eq. 6, halved): zero wherever both points lie on one circular arc.
struct Symmetric {
  static constexpr int dimension = 1;
  static double value(const PointPair& pair);
  static Eigen::Matrix<double, 1, 6> jacobian(const PointPair& pair, const Eigen::Vector3d& centre);
};

}  // namespace scan
