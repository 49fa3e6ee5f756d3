// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The default neighbour search: a kd-tree of eight children a node and full leaves of sixteen.
#pragma once

#include "libscan/search/box_search.h"

namespace scan {

// Models NeighbourSearch.
class KdTree : public BoxSearch {
 public:
  explicit KdTree(std::span<const Eigen::Vector3d> points);
};

}  // namespace scan
