// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far points scatter about the surface they were taken from.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace scan {

// One standard deviation along the normal, in the points' unit: the median, over some 2000 points
// spread through the cloud, of the residual of a quadric fitted to the neighbours, per degree of
// freedom. The neighbourhood grows from 24 points until its radius is five times that residual: a
// smaller one is a ball in the scatter, not a piece of surface. Detail of
// the surface that no quadric follows is told from scatter by pairs of points: it vanishes with
// their distance. So exact points of a rough surface have no sigma. Needs at least 16 points.
double estimate_sigma(std::span<const Eigen::Vector3d> points);

}  // namespace scan
