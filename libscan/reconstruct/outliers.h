// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Points that belong to no surface.
#pragma once

#include <span>
#include <vector>

#include "libscan/reconstruct/local_planes.h"

namespace scan {

// 1 for each point that (a) lies alone: its neighbours reach twice as far as theirs do; (b) lies in
// a thin cloud: its neighbours reach twice as far as the median point's, neither spread in a plane
// nor form a bent sheet, or do so on an island; or (c) lies beside the surface: farther off its
// neighbours' plane than half their width and than four times their thickness. Two points agree if
// both planes' normals are within 30 degrees of square to the line between them and within 60
// degrees of each other. On a sheet half of a point's neighbours agree with it (on a thin body the
// others are of the other side), and so it is for three quarters of its neighbours: among strays
// one in 400. An island of thin sheets agrees, from neighbour to neighbour, with no point that lies
// as close as the median one, and has fewer than 1 % of all points: mismatches of stereo lie so. A
// surface that is sampled thinly in places, or noisy all over, keeps its points. `planes`: of the
// points.
std::vector<char> outlying(const LocalPlanes& planes, std::span<const Eigen::Vector3d> points);

}  // namespace scan
