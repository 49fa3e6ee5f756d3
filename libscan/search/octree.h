// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Neighbour search in an octree.
#pragma once

#include "libscan/search/box_search.h"

namespace scan {

// Models NeighbourSearch.
class Octree : public BoxSearch {
 public:
  explicit Octree(std::span<const Eigen::Vector3d> points);
};

}  // namespace scan
