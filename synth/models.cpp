// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// libscan's own models: a machined part and an organic one.
#include "synth/scene.h"

namespace scan::synth {
namespace {

using Operation = CombinedShape::Operation;

PlacedShape placed(Shape shape, double x_m, double y_m, double z_m) {
  return {make_pose(Eigen::Matrix3d::Identity(), {x_m, y_m, z_m}), std::move(shape)};
}

PlacedShape unmoved(Shape shape) {
  return placed(std::move(shape), 0, 0, 0);
}

}  // namespace

Shape bracket() {
  // An L of a foot and a back with a fillet in its corner. The blend would also swell the faces
  // that both share; cutting by their common hull leaves those flat, with sharp outer edges.
  const Shape foot = BoxShape{{0.080, 0.050, 0.008}};
  const Shape back = BoxShape{{0.010, 0.050, 0.045}};
  const Shape hull = BoxShape{{0.080, 0.050, 0.045}};
  const Shape filleted = CombinedShape{
      Operation::unite, 0.008, {placed(foot, 0, 0, 0.004), placed(back, -0.035, 0, 0.0225)}};
  const Shape angle =
      CombinedShape{Operation::intersect, 0, {unmoved(filleted), placed(hull, 0, 0, 0.0225)}};
  // a thin wall (1.5 mm) across the corner, rooted in both legs, and a bore through the foot
  const Shape wall = BoxShape{{0.036, 0.0015, 0.028}};
  const Shape bore = CylinderShape{0.009, 0.030};
  const Shape ribbed =
      CombinedShape{Operation::unite, 0, {unmoved(angle), placed(wall, -0.020, 0, 0.018)}};
  return CombinedShape{Operation::subtract, 0, {unmoved(ribbed), placed(bore, 0.022, 0, 0.004)}};
}

Shape bud() {
  // The ring stands upright, a third of it inside the body: a handle.
  const Pose upright =
      make_pose(Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitX()).toRotationMatrix(),
                {0.032, 0, -0.004});
  return CombinedShape{Operation::unite,
                       0.008,
                       {unmoved(SphereShape{0.030}),
                        placed(SphereShape{0.020}, -0.008, 0, 0.040),
                        placed(SphereShape{0.015}, -0.028, 0.022, 0.012),
                        {upright, TorusShape{0.020, 0.0065}}}};
}

std::optional<Shape> catalogue_shape(std::string_view word) {
  if (word == "bracket") return bracket();
  if (word == "bud") return bud();
  return std::nullopt;
}

}  // namespace scan::synth
