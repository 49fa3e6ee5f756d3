// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The tree of boxes behind MeshSearch: eight children wide, up to eight triangles a leaf, bounds in
// single precision relative to a local origin; what they let through is decided in double. Internal
// to libscan/search.
#pragma once

#include <array>
#include <vector>

#include "libscan/core/mesh.h"
#include "libscan/search/local_frame.h"
#include "libscan/search/triangle_leaf.h"

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
  // The nearest triangle, the lowest of equally near ones. `guess`, if it is one of the triangles,
  // tells where to look first.
  Best nearest(const Eigen::Vector3d& query, std::uint32_t guess) const;

  static constexpr int width = 8;
  // Boxes of the children, coordinate by coordinate; NaN, which no limit admits, where there is
  // none. A child is a node, or with leaf_bit a leaf.
  static constexpr std::uint32_t leaf_bit = 0x80000000u;
  struct alignas(64) Node {
    float low[3][width], high[3][width];
    std::uint32_t child[width];
  };

 private:
  struct Box;
  struct Ranges;
  struct Part;
  static Ranges split(std::vector<std::uint32_t>& order,
                      const std::vector<Eigen::Vector3d>& centres, std::uint32_t begin,
                      std::uint32_t end);
  Box make_leaf(const Mesh& mesh, const Part& part);
  Box build(const Mesh& mesh, const std::vector<Eigen::Vector3d>& centres, const Part& part);
  Box build_node(const Mesh& mesh, const std::vector<Eigen::Vector3d>& centres, const Part& part);
  void offer(std::uint32_t place, const Eigen::Vector3d& query, Best& best) const;
  template <class LocalQuery, class Scalar>
  void look_into(const TriangleLeaf& leaf, const LocalQuery& local, const Eigen::Vector3d& query,
                 Scalar& limit2, Best& best) const;
  template <class LocalQuery>
  Best descend(const LocalQuery& local, const Eigen::Vector3d& query, std::uint32_t guess) const;

  LocalFrame frame_;
  std::vector<std::array<Eigen::Vector3d, 3>> corners_;  // of the triangles, in leaf order
  std::vector<std::uint32_t> index_;                     // number of each
  std::vector<std::uint32_t> leaf_of_;                   // of each number
  LargeArray<Node> nodes_;
  LargeArray<TriangleLeaf> leaves_;
};

}  // namespace scan
