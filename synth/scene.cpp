// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scene.h"

#include "libscan/core/error.h"
#include "synth/check_pose.h"
#include "synth/medium/diffusion.h"
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
  check(material.bsdf, place);
  check(material.texture, place + "/texture");
  const bool is_dielectric = std::holds_alternative<Dielectric>(material.bsdf);
  const bool has_albedo = !is_dielectric && !std::holds_alternative<Conductor>(material.bsdf);
  if (!has_albedo && !std::holds_alternative<PlainTexture>(material.texture))
    refuse(place + "/texture multiplies an albedo, which metal and clear surfaces lack");
  if (!material.interior) return;
  if (!is_dielectric)
    refuse(place + "/interior lies behind a surface that no light passes; only a dielectric does");
  check(*material.interior, place + "/interior");
}

void check_texture_corners(const Object& object, std::size_t triangles, const Material& material,
                           const std::string& place) {
  const std::vector<TextureCorners>& all = object.texture_corners;
  if (!all.empty() && all.size() != triangles)
    refuse(place + "/texture_corners has " + std::to_string(all.size()) + " entries, must have " +
           std::to_string(triangles));
  for (const TextureCorners& corners : all)
    for (const Eigen::Vector2d& corner : corners)
      if (!corner.allFinite()) refuse(place + "/texture_corners is not finite");
  if (all.empty() && std::holds_alternative<MeshTexture>(material.texture))
    refuse(place + ": its material has a picture without a width, which only a mesh with texture " +
           "coordinates takes");
}

void check_object(const Scene& scene, const Object& object, const std::string& place) {
  check_pose(object.world_from_object, place + "/world_from_object");
  if (object.material < 0 || object.material >= static_cast<int>(scene.materials.size()))
    refuse(place + "/material is " + std::to_string(object.material) + ", but the scene has " +
           std::to_string(scene.materials.size()));
  try {
    std::visit([](const auto& geometry) { check(geometry); }, object.geometry);
  } catch (const Error& error) {
    throw Error(error.trouble(), place + ": " + error.what(), error.hint());
  }
  const auto* mesh = std::get_if<Mesh>(&object.geometry);
  check_texture_corners(object, mesh ? mesh->triangles.size() : 0, scene.materials[object.material],
                        place);
  if (!mesh) return;
  if (mesh->empty()) refuse(place + ": mesh has no triangles");
  if (!std::holds_alternative<Dielectric>(scene.materials[object.material].bsdf)) return;
  if (const std::size_t open = edge_census(*mesh).boundary_edges; open > 0)
    refuse(place + ": its mesh has " + std::to_string(open) +
           " open edges, must be closed to be filled with a dielectric");
}

bool scatters_inside(const Material& material) {
  return material.interior && material.interior->scattering_per_m > 0;
}

// The Lambert surface of equal diffuse albedo.
void make_opaque(Material& material) {
  const double index = std::get<Dielectric>(material.bsdf).index;
  material.bsdf = Lambert{diffuse_albedo(*material.interior, index)};
  material.interior.reset();
}

// So that light passes quickly where the medium is thin.
void prepare(Medium& medium) {
  if (auto* grid = std::get_if<DensityGrid>(&medium.density)) set_majorants(*grid);
}

// Meshes are shells, so only shapes have an inside that light cannot leave.
void check_light(const Scene& scene, const Light& light, const std::string& place) {
  check(light, place);
  const auto* lamp = std::get_if<PointLight>(&light);
  if (!lamp) return;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const auto* shape = std::get_if<Shape>(&object.geometry);
    if (!shape || std::holds_alternative<Dielectric>(scene.materials[object.material].bsdf))
      continue;
    if (field(PlacedShape{object.world_from_object, *shape}, lamp->position_m).value_m < 0)
      refuse(place + "/position_m lies inside " + name_of("objects", object.name, i) +
             ", which is opaque");
  }
}

}  // namespace

void check(const Scene& scene) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    check_material(scene.materials[i], name_of("materials", scene.materials[i].name, i));
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    check_object(scene, scene.objects[i], name_of("objects", scene.objects[i].name, i));
  if (scene.medium) check(*scene.medium, "scene/medium");
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    check_light(scene, scene.lights[i], name_of("lights", "", i));
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

Bsdf bsdf_at(const Scene& scene, int object, std::uint32_t triangle,
             const Eigen::Vector3d& x_in_world) {
  const Object& seen = scene.objects[object];
  const Material& material = scene.materials[seen.material];
  Bsdf bsdf = material.bsdf;
  if (std::holds_alternative<PlainTexture>(material.texture)) return bsdf;
  const Eigen::Vector3d x_in_object = seen.world_from_object.linear().transpose() *
                                      (x_in_world - seen.world_from_object.translation());
  const double factor =
      texture_factor(material.texture, texture_point(seen, triangle, x_in_object));
  std::visit(
      [&](auto& kind) {
        if constexpr (requires { kind.albedo; }) kind.albedo *= factor;
      },
      bsdf);
  return bsdf;
}

bool is_clear(const Material& material) {
  return is_transmissive(material.bsdf) && has_delta(material.bsdf) && !scatters_inside(material);
}

Scene simplified(const Scene& scene, const EffectSet& effects) {
  Scene kept = scene;
  if (!effects.has(Effect::medium)) kept.medium.reset();
  if (!effects.has(Effect::scene_lights)) kept.lights.clear();
  if (!effects.has(Effect::refraction))
    std::erase_if(kept.objects, [&](const Object& object) {
      const Material& material = scene.materials[object.material];
      return std::holds_alternative<Dielectric>(material.bsdf) && !scatters_inside(material);
    });
  for (Material& material : kept.materials) {
    if (!effects.has(Effect::subsurface) && scatters_inside(material)) make_opaque(material);
    if (material.interior) prepare(*material.interior);
  }
  if (kept.medium) prepare(*kept.medium);
  return kept;
}

Scene without_clear_objects(const Scene& scene) {
  Scene kept = scene;
  std::erase_if(kept.objects,
                [&](const Object& object) { return is_clear(scene.materials[object.material]); });
  return kept;
}

}  // namespace scan::synth
