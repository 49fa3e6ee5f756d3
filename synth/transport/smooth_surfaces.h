// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The mirrors, clear bodies and smooth coats of a scene, cut into flat and curved sheets.
#pragma once

#include <optional>
#include <vector>

#include "synth/ray_caster.h"

namespace scan::synth {

// A flat facet, or the curved rest of an object's surface. Flat: the plane normal.x = offset_m, and
// the rectangle of +-half_m along `axes` around `centre` that holds it (infinite for a plane).
struct Sheet {
  int body = -1;
  bool is_flat = true;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // outward
  double offset_m = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, 2> axes = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Vector2d half_m = Eigen::Vector2d::Zero();
  // Curved: points spread over it, where the search for ways starts.
  struct Sample {
    Eigen::Vector3d point, normal;
  };
  std::vector<Sample> samples;
};

struct SmoothBody {
  int object = -1;  // of the scene
  Bsdf bsdf;
  double index = 1;                                  // inside; 1 of what light does not enter
  bool is_clear = false;                             // light passes
  double extinction_per_m = 0;                       // inside
  PlacedShape shape;                                 // of an object that is no mesh
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // of its bounds
  double size_m = 0;                                 // their diagonal; 0: unbounded
  double thickness_m = 0;                            // least extent
  std::vector<int> sheet_of_triangle;                // of a mesh
  std::vector<int> flat_sheets;  // of a shape: box +x -x +y ..., cylinder +z -z, plane
  int curved_sheet = -1;
};

// Coordinates are the world's, moved to `origin`.
class SmoothSurfaces {
 public:
  explicit SmoothSurfaces(const Scene& scene);

  Eigen::Vector3d origin;
  std::vector<SmoothBody> bodies;
  std::vector<Sheet> sheets;
  std::vector<int> flat_reflectors;  // sheets
  std::vector<int> curved;           // sheets
  double slack_m = 0;  // by which refraction may shift a way sideways: the thickest clear body
  RayCaster caster;    // of the smooth objects alone; its objects are the bodies

  const SmoothBody& body_of(int sheet) const { return bodies[sheets[sheet].body]; }
  int sheet_at(int body, std::uint32_t triangle, const Eigen::Vector3d& normal) const;
  // Whether the point lies inside a body that is a shape.
  bool is_inside(int sheet, const Eigen::Vector3d& x) const;

 private:
  void add_mesh(const Mesh& mesh, const Pose& pose, int body);
  void add_shape(const Shape& shape, const Pose& pose, int body);
  int add_flat(int body, const Eigen::Vector3d& centre, const Eigen::Matrix3d& frame,
               const Eigen::Vector2d& half_m);
  void add_curved(int body);
};

// The objects with smooth surfaces.
std::vector<int> smooth_objects(const Scene& scene);

// Change of the unit outward normal per metre at a point of a sheet.
Eigen::Matrix3d normal_gradient(const SmoothBody& body, const Sheet& sheet,
                                const Eigen::Vector3d& point, const Eigen::Vector3d& normal);

}  // namespace scan::synth
