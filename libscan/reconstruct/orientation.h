// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which way normals point, from one another.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace scan {

// Turns normals until neighbours agree as far as they can; returns how many were turned. `around`
// names the same number of neighbours for each point. Two neighbours are to agree as strongly as
// they are parallel and lie in one another's plane, so that two sheets of a thin plate do not
// speak to one another. Groups are joined by their strongest bond first, and bonds between joined
// groups add up (greedy additive contraction, Keuper et al. 2015, with two labels); bonds that
// contradict one another join nothing. What is joined keeps the side that most of its normals had;
// where they had none (less than 60 % on one side) it faces outwards from the centre of all points,
// unless all but 10 % of the bonds agreed: then a wrong bridge turned one half, as round the rim of
// a plate, and the normals stay.
//
// Normals that already agree (all but 0.5 % of the bonds) are left as they are.
std::size_t agree_with_neighbours(std::span<const Eigen::Vector3d> points,
                                  std::span<const std::uint32_t> around,
                                  std::span<Eigen::Vector3d> normals);

}  // namespace scan
