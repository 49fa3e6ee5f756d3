// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A triangle mesh whose edges can be collapsed, as long as it stays the surface that it is.
#pragma once

#include <span>
#include <vector>

#include "libscan/core/mesh.h"

namespace scan {

class CollapsingMesh {
 public:
  explicit CollapsingMesh(const Mesh& mesh);

  const Eigen::Vector3d& at(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }
  const Triangle& triangle(std::uint32_t t) const { return mesh_.triangles[t]; }
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

  // What is left, in the old order.
  Mesh mesh() const;

 private:
  bool keeps_shape(std::uint32_t moved, std::uint32_t other, const Eigen::Vector3d& place) const;
  bool names(std::uint32_t t, std::uint32_t vertex) const;

  Mesh mesh_;
  std::vector<char> is_alive_;
  std::vector<std::vector<std::uint32_t>> around_;
  std::size_t alive_ = 0;
};

}  // namespace scan
