// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The guesses of many scans as measurements of their poses.
//
// With the guesses' information E^-1 beside the data's A, the poses are those that maximise the
// product of both. Along weak motions W (observability.h) what the data tell is feigned and must
// not count: a twist is split into W a and a rest y with W^T E^-1 y = 0, and the data see the rest
// alone. The guess then decides on a by itself, and both on y:
//   a = Q W^T E^-1 e, Q = (W^T E^-1 W)^-1, e the twist to the guess;
//   y = argmin y^T (A + E^-1) y / 2 - y^T (b + E^-1 e) under W^T E^-1 y = 0.
// Where the data tell truly nothing of W, A W = 0, any split gives the same poses; this one keeps
// the errors of the parts apart: that of a has the covariance Q, that of y is not correlated.
#pragma once

#include <span>
#include <vector>

#include "libscan/core/scan.h"

namespace scan {

struct JointFrame;

// Of each scan's twist, about the frame's centre and in its unit; both empty: the errors of the
// guesses are not known.
struct GuessPrior {
  std::vector<Matrix6> information;  // E^-1; zero for scans that are not free
  std::vector<Vector6> twists;       // from the pose to the guess
  bool known() const { return !information.empty(); }
};

// The turn about a pose's origin, and then the shift of it in units of `size_m`, that take it to a
// guess.
Vector6 twist_to(const Pose& guess, const Pose& pose, double size_m);

// Of a turn about a centre and a shift of it in units of `size_m`, by the error of a guess: a turn
// w about the scanner moves the centre by w x `arm_m`, the way there from the scanner. A third of
// each square falls to each axis.
Matrix6 covariance_of(const GuessSigma& sigma, const Eigen::Vector3d& arm_m, double size_m);

// `world_from_scanner`: the guesses, of the scanners themselves; `world_from_local` and `guesses`
// of the points that the frame's centres are the origins of. The anchor's error moves all others.
GuessPrior guess_prior(const JointFrame& frame, std::span<const Pose> world_from_local,
                       std::span<const Pose> guesses, std::span<const Eigen::Vector3d> scanners,
                       std::span<const GuessSigma> sigmas, std::size_t anchor);

}  // namespace scan
