// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/recipe_scene.h"

#include <map>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/core/nearest_word.h"
#include "libscan/io/scan_file.h"
#include "libscan/io/shape_json.h"
#include "tools/recipe_materials.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

// Our own models by name.
const std::map<std::string, Shape (*)()> models = {{"bracket", synth::bracket},
                                                   {"bud", synth::bud}};
const std::map<std::string, double> mesh_units = {{"m", 1}, {"mm", 1e-3}, {"um", 1e-6}};

template <class Map>
std::vector<std::string> keys_of(const Map& map) {
  std::vector<std::string> keys;
  keys.reserve(map.size());
  for (const auto& [key, value] : map) keys.push_back(key);
  return keys;
}

// The entry of `map` that `word` names, or an error at `reader`/`key` that lists them.
template <class Map>
const typename Map::mapped_type& look_up(const Map& map, const std::string& word,
                                         const JsonReader& reader, std::string_view key) {
  const auto found = map.find(word);
  if (found != map.end()) return found->second;
  std::string known;
  for (const std::string& name : keys_of(map)) known += (known.empty() ? "" : ", ") + name;
  const std::string near = nearest_word(word, keys_of(map));
  throw Error(Trouble::input,
              reader.place() + "/" + std::string(key) + ": '" + word + "' is none of " + known,
              near.empty() ? "" : "did you mean '" + near + "'?");
}

Shape read_object_shape(JsonReader& reader) {
  if (reader.value("shape").is_string())
    return look_up(models, reader.text("shape"), reader, "shape")();
  JsonReader inner = reader.object("shape");
  Shape shape = read_shape(inner);
  inner.finish();
  return shape;
}

// Errors name the recipe's place as well as the file.
TexturedMesh read_object_mesh(const std::filesystem::path& file, const JsonReader& reader) {
  try {
    return read_textured_mesh(file);
  } catch (const Error& error) {
    throw Error(error.trouble(), reader.place() + "/mesh: " + error.what(), error.hint());
  }
}

void read_object(JsonReader reader, const std::map<std::string, int>& materials,
                 const std::filesystem::path& folder, RecipeScene& scene) {
  synth::Object object;
  std::filesystem::path file;
  double unit_m = 1;
  if (reader.has("mesh")) {
    if (reader.has("shape"))
      reader.fail("mesh", "stands beside a shape; an object has one of them");
    file = std::filesystem::absolute(folder / reader.text("mesh")).lexically_normal();
    unit_m = look_up(mesh_units, reader.text("unit"), reader, "unit");
    TexturedMesh textured = read_object_mesh(file, reader);
    if (!(area_m2(textured.mesh) > 0)) reader.fail("mesh", "none of its triangles has an area");
    for (auto& vertex : textured.mesh.vertices) vertex *= unit_m;
    object.geometry = std::move(textured.mesh);
    object.texture_corners = std::move(textured.corners);
  } else {
    object.geometry = read_object_shape(reader);
  }
  object.name = reader.text("name", "object " + std::to_string(scene.scene.objects.size()));
  object.world_from_object =
      reader.has("world_from_object")
          ? pose_from_json(reader.value("world_from_object"), reader.place() + "/world_from_object")
          : reader.placement();
  object.material = look_up(materials, reader.text("material"), reader, "material");
  reader.finish();
  scene.scene.objects.push_back(std::move(object));
  scene.mesh_files.push_back(file);
  scene.mesh_units_m.push_back(unit_m);
}

// Errors name the recipe's file as well; `place` is that of the scene in it.
void check_at(const synth::Scene& scene, const std::string& place) {
  try {
    check(scene);
  } catch (const Error& error) {
    const std::string file = place.substr(0, place.rfind('/') + 1);
    throw Error(error.trouble(), file + error.what(), error.hint());
  }
}

std::string unit_name(double unit_m) {
  for (const auto& [name, value] : mesh_units)
    if (value == unit_m) return name;
  return "m";
}

}  // namespace

std::vector<std::string> model_names() {
  return keys_of(models);
}

std::vector<std::string> mesh_unit_names() {
  return keys_of(mesh_units);
}

RecipeScene read_scene(JsonReader reader, const std::filesystem::path& folder,
                       double wavelength_m) {
  RecipeScene scene;
  std::map<std::string, int> materials;
  JsonReader list = reader.object("materials");
  for (const std::string& name : list.keys()) {
    materials[name] = static_cast<int>(scene.scene.materials.size());
    scene.texture_files.emplace_back();
    scene.scene.materials.push_back(
        read_material(list.object(name), name, wavelength_m, folder, scene.texture_files.back()));
  }
  for (JsonReader& object : reader.objects("objects"))
    read_object(std::move(object), materials, folder, scene);
  if (scene.scene.objects.empty()) reader.fail("objects", "is empty, must have at least one");
  if (reader.has("lights"))
    for (JsonReader& light : reader.objects("lights")) {
      scene.lights.push_back(read_light(std::move(light), folder));
      scene.scene.lights.push_back(scene.lights.back().light);
    }
  if (reader.has("medium") && !reader.value("medium").is_null()) {
    scene.medium = read_medium(reader.object("medium"), folder, wavelength_m);
    scene.scene.medium = scene.medium->medium;
  }
  reader.finish();
  check_at(scene.scene, reader.place());
  return scene;
}

ordered_json to_json(const RecipeScene& recipe) {
  ordered_json materials = ordered_json::object(), objects = ordered_json::array();
  for (std::size_t i = 0; i < recipe.scene.materials.size(); ++i)
    materials[recipe.scene.materials[i].name] =
        to_json(recipe.scene.materials[i], recipe.texture_files[i]);
  for (std::size_t i = 0; i < recipe.scene.objects.size(); ++i) {
    const synth::Object& object = recipe.scene.objects[i];
    ordered_json entry = {{"name", object.name}};
    if (const Shape* shape = std::get_if<Shape>(&object.geometry)) {
      entry["shape"] = to_json(*shape);
    } else {
      entry["mesh"] = recipe.mesh_files[i].string();
      entry["unit"] = unit_name(recipe.mesh_units_m[i]);
    }
    entry["material"] = recipe.scene.materials[static_cast<std::size_t>(object.material)].name;
    entry["world_from_object"] = to_json(object.world_from_object);
    objects.push_back(std::move(entry));
  }
  ordered_json lights = ordered_json::array();
  for (const RecipeLight& light : recipe.lights) lights.push_back(to_json(light));
  ordered_json json = {{"objects", objects}, {"materials", materials}, {"lights", lights}};
  if (recipe.medium) json["medium"] = to_json(*recipe.medium);
  return json;
}

}  // namespace scan
