// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Analytic solids and their combinations: signed distance, gradient, closest point, bounds.
//
// To add a shape: 1. a plain struct here; 2. its name in the variant; 3. `field` and `bounds_of` in
// shape.cpp; 4. its keys in libscan/io/shape_json.cpp. The compiler names what is missing, and
// shape_test.cpp walks the variant.
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "libscan/core/point_cloud.h"

namespace scan {

// The solid z <= 0; its surface is the plane z = 0 with normal +z.
struct PlaneShape {};
// Centred at the origin.
struct SphereShape {
  double radius_m = 0;
};
// Around the z axis, from -height/2 to +height/2, with flat ends.
struct CylinderShape {
  double radius_m = 0;
  double height_m = 0;
};
// Centred at the origin; its edges are rounded by `rounding_m` (the outer size stays).
struct BoxShape {
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  double rounding_m = 0;
};
// Around the z axis; the tube's centre line has the major radius, which is not below the minor.
struct TorusShape {
  double major_radius_m = 0;
  double minor_radius_m = 0;
};

struct PlacedShape;

// `unite`: any part; `intersect`: all parts; `subtract`: the first without the others. Parts are
// combined from left to right. With blend_m > 0 edges become fillets about that wide (quadratic
// smooth minimum); with 0 they are sharp.
struct CombinedShape {
  enum class Operation { unite, intersect, subtract };
  Operation operation = Operation::unite;
  double blend_m = 0;
  std::vector<PlacedShape> parts;
};

using Shape =
    std::variant<PlaneShape, SphereShape, CylinderShape, BoxShape, TorusShape, CombinedShape>;

struct PlacedShape {
  Pose parent_from_shape = Pose::Identity();
  Shape shape;
};

// Throws scan::Error (input), naming shape, field and value, for sizes that are not positive and
// finite or for an empty combination.
void check(const Shape& shape);

struct DistanceField {
  double value_m;            // negative inside
  Eigen::Vector3d gradient;  // length at most 1
};

// The signed field of a shape, in the shape's frame. For the five simple shapes the value is the
// exact distance. For a combination it is a bound: |value| is at most the distance, its zero set is
// the surface, and it is 1-Lipschitz, so a ray may step by it.
DistanceField field(const Shape& shape, const Eigen::Vector3d& x_in_shape);
DistanceField field(const PlacedShape& placed, const Eigen::Vector3d& x_in_parent);

// The surface point nearest to x. Exact to rounding for the simple shapes. Of a combination the
// faces, edges and corners that its parts form are looked at in turn, each exact to rounding where
// the surface is smooth and to about 1e-9 of the distance otherwise; where the combination is
// blended, or x is farther from it than its parts' radii of curvature, it may be a local minimum.
Eigen::Vector3d closest_point(const PlacedShape& placed, const Eigen::Vector3d& x_in_parent);

// A box around the solid, in the parent's frame; infinite for a plane.
Bounds bounds_of(const PlacedShape& placed);

}  // namespace scan
