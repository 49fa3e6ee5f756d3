// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The tree of boxes behind MeshSearch: eight children wide, one triangle a leaf, boxes in single
// precision relative to a local origin; what they let through is decided in double. Internal to
// libscan/search.
#pragma once

#include <array>
#include <vector>

#include "libscan/core/mesh.h"
#include "libscan/search/local_frame.h"

namespace scan {

class TriangleTree {
 public:
  // `mesh` has been checked and has triangles.
  explicit TriangleTree(const Mesh& mesh);

  struct Best {
    double distance2_m2 = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = 0;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
  };
  // Makes the triangle of this number the best if it is nearer, or as near and of a lower number.
  void offer(std::uint32_t triangle, const Eigen::Vector3d& query, Best& best) const;
  // Offers all triangles that may be nearer than the best.
  void search(const Eigen::Vector3d& query, Best& best) const;
  std::size_t size() const { return index_.size(); }

  static constexpr int width = 8;
  // Boxes of the children, coordinate by coordinate; NaN, which no limit admits, where there is
  // none. A child is a node, or with leaf_bit a place in leaf order.
  struct alignas(64) Node {
    float low[3][width], high[3][width];
    std::uint32_t child[width];
  };

 private:
  struct Box;
  struct Ranges;
  static Ranges split(std::vector<std::uint32_t>& order,
                      const std::vector<Eigen::Vector3d>& centres, std::uint32_t begin,
                      std::uint32_t end);
  Box make_leaf(const Mesh& mesh, std::uint32_t place);
  Box build(const Mesh& mesh, const std::vector<Eigen::Vector3d>& centres, std::uint32_t self,
            std::uint32_t begin, std::uint32_t end);
  void offer_place(std::uint32_t place, const Eigen::Vector3d& query, Best& best) const;
  template <class LocalQuery>
  void descend(const LocalQuery& local, const Eigen::Vector3d& query, Best& best) const;

  LocalFrame frame_;
  std::vector<std::array<Eigen::Vector3d, 3>> corners_;  // of the triangles, in leaf order
  std::vector<std::uint32_t> index_;                     // number of each
  std::vector<std::uint32_t> place_;                     // of each number
  LargeArray<Node> nodes_;
};

}  // namespace scan
