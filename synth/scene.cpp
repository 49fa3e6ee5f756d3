// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scene.h"

#include "libscan/core/error.h"
#include "synth/texture.h"

namespace scan::synth {
namespace {

[[noreturn]] void refuse(const std::string& message) {
  throw Error(Trouble::input, message);
}

std::string name_of(const char* kind, const std::string& name, std::size_t index) {
  return "scene/" + std::string(kind) + "/" + (name.empty() ? std::to_string(index) : name);
}

void check_material(const Material& material, const std::string& place) {
  if (const auto* matt = std::get_if<Lambert>(&material.bsdf))
    if (!(matt->albedo >= 0 && matt->albedo <= 1))
      refuse(place + "/albedo is " + std::to_string(matt->albedo) + ", must be from 0 to 1");
  check(material.texture, place + "/texture");
}

void check_pose(const Pose& pose, const std::string& place) {
  if (!pose.matrix().allFinite()) refuse(place + "/world_from_object is not finite");
  const Eigen::Matrix3d r = pose.linear();
  const double error = (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (error > 1e-9 || r.determinant() < 0)
    refuse(place + "/world_from_object is no rigid motion: R^T R differs from 1 by " +
           std::to_string(error) + ", at most 1e-9");
}

void check_object(const Scene& scene, const Object& object, const std::string& place) {
  check_pose(object.world_from_object, place);
  if (object.material < 0 || object.material >= static_cast<int>(scene.materials.size()))
    refuse(place + "/material is " + std::to_string(object.material) + ", but the scene has " +
           std::to_string(scene.materials.size()));
  try {
    std::visit([](const auto& geometry) { check(geometry); }, object.geometry);
  } catch (const Error& error) {
    throw Error(error.trouble(), place + ": " + error.what(), error.hint());
  }
  const auto* mesh = std::get_if<Mesh>(&object.geometry);
  if (mesh && mesh->empty()) refuse(place + ": mesh has no triangles");
}

}  // namespace

void check(const Scene& scene) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    check_material(scene.materials[i], name_of("materials", scene.materials[i].name, i));
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    check_object(scene, scene.objects[i], name_of("objects", scene.objects[i].name, i));
}

TrueSurface true_surface(const Scene& scene) {
  TrueSurface surface;
  for (const Object& object : scene.objects) {
    if (const auto* shape = std::get_if<Shape>(&object.geometry))
      surface.shapes.push_back({object.world_from_object, *shape});
    else
      surface.meshes.push_back(
          transformed(object.world_from_object, std::get<Mesh>(object.geometry)));
  }
  return surface;
}

Bsdf bsdf_at(const Scene& scene, int object, const Eigen::Vector3d& x_in_world) {
  const Object& seen = scene.objects[object];
  const Material& material = scene.materials[seen.material];
  Bsdf bsdf = material.bsdf;
  if (std::holds_alternative<PlainTexture>(material.texture)) return bsdf;
  const Eigen::Vector3d x_in_object = seen.world_from_object.linear().transpose() *
                                      (x_in_world - seen.world_from_object.translation());
  const double factor = texture_factor(material.texture, x_in_object);
  std::visit(
      [&](auto& kind) {
        if constexpr (requires { kind.albedo; }) kind.albedo *= factor;
      },
      bsdf);
  return bsdf;
}

double albedo_at(const Scene& scene, int object, const Eigen::Vector3d& x_in_world) {
  const Bsdf bsdf = bsdf_at(scene, object, x_in_world);
  const auto* matt = std::get_if<Lambert>(&bsdf);
  return matt ? matt->albedo : 0;
}

bool is_clear(const Material& material) {
  const auto* glass = std::get_if<Dielectric>(&material.bsdf);
  return glass && glass->roughness == 0 &&
         !(material.interior && material.interior->scattering_per_m > 0);
}

Scene simplified(const Scene& scene, const EffectSet& effects) {
  Scene kept = scene;
  if (!effects.has(Effect::medium)) kept.medium.reset();
  if (!effects.has(Effect::scene_lights)) kept.lights.clear();
  if (!effects.has(Effect::refraction))
    std::erase_if(kept.objects, [&](const Object& object) {
      const Material& material = scene.materials[object.material];
      return std::holds_alternative<Dielectric>(material.bsdf) &&
             !(material.interior && material.interior->scattering_per_m > 0);
    });
  return kept;
}

}  // namespace scan::synth
