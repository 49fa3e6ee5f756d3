// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The zero level set of any function, followed from cell to cell (Wyvill et al. 1986).
#pragma once

#include <functional>
#include <span>

#include "libscan/core/mesh.h"

namespace scan {

// The function's value at a place of the unit cube, negative inside; NaN where it is not known.
using UnitField = std::function<double(const Eigen::Vector3d& u)>;

// On cells of 2^-depth, from those that hold the seeds (and their neighbours) over each face that
// the surface crosses, to the cube's walls or to corners where the field is not known: there the
// surface ends. Vertices are roots along cell edges. Oriented, manifold; the same for any order of
// the seeds and any number of threads. Throws scan::Error (usage) for a depth above 20, (resource)
// if more than `most_cells` cells are crossed.
Mesh followed_surface(std::span<const Eigen::Vector3d> seeds, int depth, const UnitField& field,
                      std::size_t most_cells = 100'000'000);

}  // namespace scan
