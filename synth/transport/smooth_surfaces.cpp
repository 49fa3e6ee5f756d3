// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/smooth_surfaces.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "libscan/core/error.h"
#include "libscan/core/random.h"
#include "synth/shape_rays.h"
#include "synth/solid.h"

namespace scan::synth {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t samples_per_sheet = 96;

double index_inside(const Bsdf& bsdf) {
  const auto* glass = std::get_if<Dielectric>(&bsdf);
  return glass ? glass->index : 1;
}

Eigen::Vector3d origin_of_smooth(const Scene& scene) {
  Scene smooth;
  for (const int object : smooth_objects(scene)) smooth.objects.push_back(scene.objects[object]);
  return scene_origin(smooth);
}

Scene smooth_scene(const Scene& scene, const Eigen::Vector3d& origin) {
  Scene smooth;
  smooth.materials = scene.materials;
  for (const int object : smooth_objects(scene)) {
    smooth.objects.push_back(scene.objects[object]);
    smooth.objects.back().world_from_object.translation() -= origin;
  }
  return smooth;
}

SmoothBody make_body(const Scene& scene, int object) {
  const Material& material = scene.materials[scene.objects[object].material];
  SmoothBody body{.object = object, .bsdf = material.bsdf};
  body.index = index_inside(material.bsdf);
  body.is_clear = std::holds_alternative<Dielectric>(material.bsdf);
  if (!material.interior) return body;
  if (!std::holds_alternative<Homogeneous>(material.interior->density))
    throw Error(Trouble::input, "material " + material.name +
                                    "/interior: a grid, but light is led through clear bodies of "
                                    "even density only");
  body.extinction_per_m = material.interior->absorption_per_m + material.interior->scattering_per_m;
  return body;
}

// Two triangles lie in one plane if their normals agree to 1e-9 and their offsets to 1e-9 of the
// mesh's size. Where rounding parts what belongs together, both halves are looked at: a sheet may
// be a part of a facet.
using PlaneKey = std::array<long, 4>;
PlaneKey plane_key(const Eigen::Vector3d& normal, double offset_m, double size_m) {
  return {std::lround(normal.x() * 1e9), std::lround(normal.y() * 1e9),
          std::lround(normal.z() * 1e9), std::lround(offset_m / size_m * 1e9)};
}

// x axis along the longest side of the triangle, z along its normal.
Eigen::Matrix3d triangle_frame(const std::array<Eigen::Vector3d, 3>& corners,
                               const Eigen::Vector3d& normal) {
  Eigen::Vector3d longest = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d side = corners[(k + 1) % 3] - corners[k];
    if (side.norm() > longest.norm()) longest = side;
  }
  Eigen::Matrix3d frame;
  frame << longest.normalized(), normal.cross(longest.normalized()), normal;
  return frame;
}

}  // namespace

std::vector<int> smooth_objects(const Scene& scene) {
  std::vector<int> found;
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (has_delta(scene.materials[scene.objects[i].material].bsdf))
      found.push_back(static_cast<int>(i));
  return found;
}

SmoothSurfaces::SmoothSurfaces(const Scene& scene)
    : origin(origin_of_smooth(scene)), caster(smooth_scene(scene, origin)) {
  for (const int object : smooth_objects(scene)) {
    const int body = static_cast<int>(bodies.size());
    bodies.push_back(make_body(scene, object));
    Pose pose = scene.objects[object].world_from_object;
    pose.translation() -= origin;
    if (const auto* mesh = std::get_if<Mesh>(&scene.objects[object].geometry))
      add_mesh(*mesh, pose, body);
    else
      add_shape(std::get<Shape>(scene.objects[object].geometry), pose, body);
  }
  for (std::size_t s = 0; s < sheets.size(); ++s) {
    const SmoothBody& body = body_of(static_cast<int>(s));
    const bool reflects = !body.is_clear || body.index != 1;
    if (!sheets[s].is_flat)
      curved.push_back(static_cast<int>(s));
    else if (reflects)
      flat_reflectors.push_back(static_cast<int>(s));
    if (body.is_clear) slack_m = std::max(slack_m, body.thickness_m);
  }
}

void SmoothSurfaces::add_mesh(const Mesh& mesh, const Pose& pose, int body) {
  Bounds box;
  for (const Eigen::Vector3d& v : mesh.vertices) box.extend(v);
  bodies[body].centre = pose * box.center();
  bodies[body].size_m = box.diagonal().norm();
  bodies[body].thickness_m = box.sizes().minCoeff();
  std::map<PlaneKey, int> known;
  std::vector<Bounds> extents;  // of the sheets from `first` on, in their own frames
  const std::size_t first = sheets.size();
  for (const Triangle& t : mesh.triangles) {
    const std::array<Eigen::Vector3d, 3> corners = {
        pose * mesh.vertices[t[0]], pose * mesh.vertices[t[1]], pose * mesh.vertices[t[2]]};
    const Eigen::Vector3d area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (!(area.norm() > 0)) {
      bodies[body].sheet_of_triangle.push_back(-1);
      continue;
    }
    const Eigen::Vector3d normal = area.normalized();
    const PlaneKey key = plane_key(normal, normal.dot(corners[0]), bodies[body].size_m);
    const auto [place, is_new] = known.try_emplace(key, static_cast<int>(sheets.size()));
    if (is_new) {
      add_flat(body, corners[0], triangle_frame(corners, normal), Eigen::Vector2d::Zero());
      extents.emplace_back();
    }
    const Sheet& sheet = sheets[place->second];
    for (const Eigen::Vector3d& corner : corners) {
      const Eigen::Vector2d across = sheet.axes.transpose() * (corner - sheet.centre);
      extents[place->second - first].extend(Eigen::Vector3d(across.x(), across.y(), 0));
    }
    bodies[body].sheet_of_triangle.push_back(place->second);
  }
  for (std::size_t i = 0; i < extents.size(); ++i) {
    Sheet& sheet = sheets[first + i];
    sheet.centre += sheet.axes * extents[i].center().head<2>();
    sheet.half_m = extents[i].sizes().head<2>() / 2;
  }
}

int SmoothSurfaces::add_flat(int body, const Eigen::Vector3d& centre, const Eigen::Matrix3d& frame,
                             const Eigen::Vector2d& half_m) {
  Sheet sheet{.body = body, .is_flat = true, .normal = frame.col(2), .centre = centre};
  sheet.offset_m = sheet.normal.dot(centre);
  sheet.axes = frame.leftCols<2>();
  sheet.half_m = half_m;
  sheets.push_back(sheet);
  return static_cast<int>(sheets.size()) - 1;
}

void SmoothSurfaces::add_shape(const Shape& shape, const Pose& pose, int body) {
  SmoothBody& made = bodies[body];
  made.shape = {pose, shape};
  const Bounds box = bounds_of(PlacedShape{Pose::Identity(), shape});
  if (is_finite(box)) {
    made.centre = pose * box.center();
    made.size_m = box.diagonal().norm();
    made.thickness_m = box.sizes().minCoeff();
  }
  const auto face = [&](int axis, double side, const Eigen::Vector3d& half_m) {
    Eigen::Matrix3d frame;
    frame << Eigen::Vector3d::Unit((axis + 1) % 3), Eigen::Vector3d::Unit((axis + 2) % 3),
        Eigen::Vector3d::Unit(axis);
    if (side < 0) frame.rightCols<2>() *= -1;
    const Eigen::Vector3d centre = side * half_m(axis) * Eigen::Vector3d::Unit(axis);
    made.flat_sheets.push_back(add_flat(body, pose * centre, pose.linear() * frame,
                                        {half_m((axis + 1) % 3), half_m((axis + 2) % 3)}));
  };
  if (std::holds_alternative<PlaneShape>(shape)) {
    face(2, 1, {infinity, infinity, 0});
  } else if (const auto* brick = std::get_if<BoxShape>(&shape); brick && brick->rounding_m == 0) {
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {1.0, -1.0}) face(axis, side, brick->size_m / 2);
  } else if (const auto* rod = std::get_if<CylinderShape>(&shape)) {
    for (const double side : {1.0, -1.0})
      face(2, side, {rod->radius_m, rod->radius_m, rod->height_m / 2});
    add_curved(body);
  } else {
    add_curved(body);
  }
}

// Points where lines in all directions through the body cross the sheet: spread by area (Cauchy and
// Crofton).
void SmoothSurfaces::add_curved(int body) {
  SmoothBody& made = bodies[body];
  made.curved_sheet = static_cast<int>(sheets.size());
  sheets.push_back({.body = body, .is_flat = false});
  Sheet& sheet = sheets.back();
  const Bounds box = bounds_of(made.shape);
  if (!is_finite(box)) return;  // unbounded combinations offer no starts
  const double radius_m = box.diagonal().norm() / 2;
  for (std::uint64_t line = 0; line < 1024 && sheet.samples.size() < samples_per_sheet; ++line) {
    RandomStream random(0, 0, line);
    Eigen::Vector3d ends[2];
    for (Eigen::Vector3d& end : ends) {
      for (int axis = 0; axis < 3; ++axis) end(axis) = random.normal();
      end = box.center() + radius_m * end.normalized();
    }
    Ray ray{ends[0], (ends[1] - ends[0]).normalized()};
    while (const auto hit = intersect(made.shape, ray)) {
      const Eigen::Vector3d point = ray.origin + hit->distance_m * ray.direction;
      if (sheet_at(body, 0, hit->normal) == made.curved_sheet)
        sheet.samples.push_back({point, hit->normal.normalized()});
      ray.min_m = hit->distance_m + 1e-9 * radius_m;
    }
  }
}

int SmoothSurfaces::sheet_at(int body, std::uint32_t triangle,
                             const Eigen::Vector3d& normal) const {
  const SmoothBody& hit = bodies[body];
  if (!hit.sheet_of_triangle.empty()) return hit.sheet_of_triangle[triangle];
  for (const int sheet : hit.flat_sheets)
    if (sheets[sheet].normal.dot(normal) > 1 - 1e-9) return sheet;
  return hit.curved_sheet;
}

bool SmoothSurfaces::is_inside(int sheet, const Eigen::Vector3d& x) const {
  return field(body_of(sheet).shape, x).value_m < 0;
}

Eigen::Matrix3d normal_gradient(const SmoothBody& body, const Sheet& sheet,
                                const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  if (sheet.is_flat) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d tangential = Eigen::Matrix3d::Identity() - normal * normal.transpose();
  if (const auto* ball = std::get_if<SphereShape>(&body.shape.shape))
    return tangential / ball->radius_m;
  if (const auto* rod = std::get_if<CylinderShape>(&body.shape.shape)) {
    const Eigen::Vector3d round = body.shape.parent_from_shape.linear().col(2).cross(normal);
    return round * round.transpose() / rod->radius_m;
  }
  // Central differences of the field's gradient; the step balances its cube root of rounding.
  const double step_m = 1e-5 * body.size_m;
  Eigen::Matrix3d gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = step_m * tangential.col(axis);
    gradient.col(axis) = (field(body.shape, point + step).gradient.normalized() -
                          field(body.shape, point - step).gradient.normalized()) /
                         (2 * step_m);
  }
  return gradient;
}

}  // namespace scan::synth
