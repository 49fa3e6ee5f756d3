// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// One step of an alignment over fixed pairs, and what they fix of the pose. Twists are about the
// centre of a frame, translations in units of its size.
#pragma once

#include <span>

#include "libscan/align/observability.h"
#include "libscan/align/pairs.h"

namespace scan {

// Centre and size of the pairs, in the target's local frame.
DataFrame frame_of(const PairFinder& finder, const Pose& pose, std::span<const Couple> couples);

// Root mean square of the residuals, as the loss weighs them, metres.
double rms_m(std::span<const Couple> couples, const WelschLoss& loss);

// Sums over the pairs of w J^T J and -w J^T r, r in units of the frame's size, and of w and
// w r^2.
struct NormalEquations {
  Matrix6 a = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
  double weights = 0, squares_m2 = 0;
  NormalEquations& operator+=(const NormalEquations& other) {
    a += other.a;
    b += other.b;
    weights += other.weights;
    squares_m2 += other.squares_m2;
    return *this;
  }
};
NormalEquations normal_equations(const PairFinder& finder, const Pose& pose,
                                 std::span<const Couple> couples, const WelschLoss& loss,
                                 const DataFrame& frame);

struct Step {
  Vector6 twist = Vector6::Zero();
  double change_m = 0;  // root of the weighted sum of squared changes of the residuals
  Matrix6 squares_m2 = Matrix6::Zero();  // that sum of any twist t: t^T squares_m2 t
  double sigma_m = 0;                    // rms_m of the pairs
  // Of the loss over that of the weighted squares, of point-to-point 1: rho'' / w = 1 - r^2 / s^2.
  double bend = 1;
};

// The step that lowers the weighted squares of the residuals most, with no part along `withheld`:
// by Gauss and Newton, of point-to-point the exact minimum over all rotations.
Step best_step(const PairFinder& finder, const Pose& pose, std::span<const Couple> couples,
               const WelschLoss& loss, const DataFrame& frame, const TwistBasis& withheld);

// The pose moved by a twist.
Pose moved(const Pose& pose, Vector6 twist, const DataFrame& frame);

// What the planes at the pairs fix. The errors of their normals are drawn from the local fits, or,
// of scans that lie on each other, from the difference of both scans' normals: that holds the noise
// which neighbours share, too.
enum class NormalErrors { of_fits, between_scans };
MotionInformation motion_information(const PairFinder& finder, const Pose& pose,
                                     std::span<const Couple> couples, const DataFrame& frame,
                                     NormalErrors errors);

// What one pair pulls the pose with, w J^T r, and how strongly it holds it; in units of the frame's
// size. The curvature is taken between the normals of both scans, whose noise is independent and so
// adds nothing to it.
struct Pull {
  Vector6 gradient = Vector6::Zero();
  Matrix6 curvature = Matrix6::Zero();
};
Pull pull_of(const PairFinder& finder, const Pose& pose, const Couple& couple,
             const WelschLoss& loss, const DataFrame& frame);

// Inverse covariance of the pose that solves the pairs' equations, as a twist about the frame's
// centre in (rad, m), zero along `weak`: B^-1 M B^-1 with the curvature B of the loss and the
// scatter M of the pairs' gradients (Huber 1967). M is the sum of the gradients' squares, times
// what noise that neighbours share, points that several pairs have in common and errors of the
// normals add to the scatter of sums (shared_noise.h). B is taken between the normals of both
// scans, whose noise is independent and so adds nothing to it, and is less by what the partners'
// choice hides of a motion (PairFinder::shown_share).
Matrix6 pose_information(const PairFinder& finder, const Pose& pose,
                         std::span<const Couple> couples, const WelschLoss& loss,
                         const DataFrame& frame, const TwistBasis& weak);

}  // namespace scan
