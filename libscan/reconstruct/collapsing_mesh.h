// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A triangle mesh whose edges can be collapsed or flipped, as long as it stays the surface that it
// is.
#pragma once

#include <span>
#include <vector>

#include "libscan/core/mesh.h"

namespace scan {

// Height over longest side of a triangle that faces nowhere: rounding or chance decides its normal.
inline constexpr double sliver_height = 1e-3;

class CollapsingMesh {
 public:
  explicit CollapsingMesh(const Mesh& mesh);

  const Eigen::Vector3d& at(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }
  const Triangle& triangle(std::uint32_t t) const { return mesh_.triangles[t]; }
  bool is_alive(std::uint32_t t) const { return is_alive_[t]; }
  // Triangles at a vertex; none: it is gone.
  std::span<const std::uint32_t> around(std::uint32_t vertex) const { return around_[vertex]; }
  // Ascending, without itself.
  std::vector<std::uint32_t> neighbours(std::uint32_t vertex) const;
  bool is_on_rim(std::uint32_t vertex) const;
  std::size_t alive() const { return alive_; }

  // Whether merging `gone` into `kept` at `place` leaves a manifold (the link condition, Dey et al.
  // 1999) in which no triangle turns by more than 60 degrees or gets thinner than 1 : 100, or than
  // before.
  bool may_collapse(std::uint32_t kept, std::uint32_t gone, const Eigen::Vector3d& place) const;
  void collapse(std::uint32_t kept, std::uint32_t gone, const Eigen::Vector3d& place);

  // Whether the two triangles of an edge may be cut along their other diagonal: if that is not an
  // edge already, and neither half turns by more than 60 degrees from the rounder of the two or is
  // as thin as the thinner one; or of two slivers, if the other diagonal is shorter.
  bool may_flip(std::uint32_t a, std::uint32_t b) const;
  void flip(std::uint32_t a, std::uint32_t b);

  // What is left, in the old order; `vertex_of` gets the old index of each vertex.
  Mesh mesh() const;
  Mesh mesh(std::vector<std::uint32_t>& vertex_of) const;

 private:
  bool keeps_shape(std::uint32_t moved, std::uint32_t other, const Eigen::Vector3d& place) const;
  bool names(std::uint32_t t, std::uint32_t vertex) const;
  // The triangle in which b follows a; the number of all for none.
  std::uint32_t triangle_of(std::uint32_t a, std::uint32_t b) const;
  std::uint32_t corner_beside(std::uint32_t t, std::uint32_t a, std::uint32_t b) const;

  Mesh mesh_;
  std::vector<char> is_alive_;
  std::vector<std::vector<std::uint32_t>> around_;
  std::size_t alive_ = 0;
};

}  // namespace scan
