// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The parts of a true surface prepared for questions: what is inside, what is hidden, what is near.
#pragma once

#include <memory>
#include <vector>

#include "libscan/search/closest_point.h"
#include "libscan/verify/truth.h"

namespace scan {

// The nearest point of one part. `signed_distance_m` is negative behind the surface.
struct PartNearest {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
  double signed_distance_m = 0;
  std::uint32_t triangle = no_triangle;  // of a mesh
};

// A mesh with its search tree and the pseudo-normals that tell inside from outside at edges and
// corners too (Baerentzen and Aanaes 2005).
class MeshPart {
 public:
  explicit MeshPart(const Mesh& mesh);
  // `guess`: as for MeshSearch::closest.
  PartNearest nearest(const Eigen::Vector3d& x, std::uint32_t guess = no_triangle) const;
  bool is_solid() const { return solid_; }  // watertight, so it has an inside
  const Mesh& mesh() const { return mesh_; }

 private:
  Eigen::Vector3d triangle_normal(std::uint32_t triangle) const;
  Eigen::Vector3d pseudo_normal(std::uint32_t triangle, const Eigen::Vector3d& point) const;

  Mesh mesh_;
  MeshSearch search_;
  std::vector<Eigen::Vector3d> corner_normals_;  // weighted by angle
  std::vector<Triangle> neighbour_;              // across the edge from corner k to k + 1
  bool solid_ = false;
};

struct TrueSurfaceParts {
  explicit TrueSurfaceParts(const TrueSurface& surface);

  std::size_t size() const { return shapes.size() + meshes.size(); }
  // Is x inside the solid of the part? Meshes with a boundary have no inside.
  bool contains(std::size_t part, const Eigen::Vector3d& x) const;
  // Is a surface point of `part` covered by another solid, that is, does its outer side lie in one?
  bool is_hidden(std::size_t part, const Eigen::Vector3d& point,
                 const Eigen::Vector3d& normal) const;

  std::vector<PlacedShape> shapes;                // parts 0 ...
  std::vector<std::unique_ptr<MeshPart>> meshes;  // ... then these
  PlacedShape all_shapes;                         // the union of the shapes, if there are any
  Bounds bounds;                                  // of the parts that have bounds; may be empty
  double outer_step_m = 0;                        // how far outside is_hidden looks
};

}  // namespace scan
