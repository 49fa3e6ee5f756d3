// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pairs of clouds with a known pose for the study of convergence basins: two samples of a shape
// whose bounding box has a diagonal of 1 m, each without one end.
#pragma once

#include <array>
#include <string>

#include "tests/benchmarks/split_pairs.h"

namespace scan::test {

// A machined part, an organic form, a blended vessel, planes alone, a cylinder that only a fin
// keeps from turning, and an open height field.
inline constexpr std::array basin_shapes = {"bracket", "bud", "vessel", "boxes", "flask", "waves"};

// `count` points each, with noise of 1 mm, that share the given part of their surface.
PairCase basin_pair(const std::string& shape, double overlap, std::size_t count,
                    std::uint64_t seed);

// The start turned about the middle of the source and shifted, about and along random directions.
// Other programs need a greatest pair distance: they are told how far the start puts the points off
// (root mean square), which nobody knows in practice, but at least 5 % of the size; and their grid
// has cells of a tenth of it.
void start_off(PairCase& pair, double turn_deg, double shift_m, std::uint64_t seed);

// Root mean square distance between where a pose and the true one put the source's points, metres.
double moved_rms_m(const PairCase& pair, const Pose& pose);

}  // namespace scan::test
