// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Points that belong to no surface.
#pragma once

#include <span>
#include <vector>

#include "libscan/reconstruct/local_planes.h"

namespace scan {

// 1 for each point that (a) lies alone: its neighbours reach twice as far as theirs do; (b)
// lies in a thin cloud: its neighbours reach twice as far as the median point's and do not
// spread in a plane; or (c) lies beside the surface: farther off its neighbours' plane than half
// their width and than four times their thickness. A surface that is sampled thinly in places, or
// noisy all over, keeps its points: there neighbours spread in a plane, or reach as far as others.
std::vector<char> outlying(const LocalPlanes& planes);

}  // namespace scan
