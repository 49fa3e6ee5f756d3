// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/scene_schema.h"

#include "synth/bsdf/fresnel.h"
#include "tools/field_schema.h"
#include "tools/recipe_materials.h"
#include "tools/recipe_scene.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

const ordered_json number = {{"type", "number"}};
const ordered_json text = {{"type", "string"}};
const ordered_json shape_reference = {{"$ref", "#/$defs/shape"}};

ordered_json with_required(ordered_json schema, std::initializer_list<const char*> keys) {
  for (const char* key : keys) require(schema, key);
  return schema;
}

void add_required_quantity(ordered_json& schema, std::string_view name, const ordered_json& values,
                           Quantity quantity = Quantity::length) {
  add_quantity(schema, name, quantity, values);
  std::vector<std::string> keys;
  for (const std::string& suffix : unit_suffixes(quantity))
    keys.push_back(std::string(name) + suffix);
  require_one_of(schema, keys);
}

// Where a thing stands: as a matrix, or by its position and three turns about x, y, z.
void add_placement(ordered_json& schema, const char* matrix_key) {
  schema["properties"][matrix_key] = matrix_schema();
  add_quantity(schema, "position", Quantity::length, three_numbers_schema());
  schema["properties"]["rotation_deg"] = three_numbers_schema();
}

ordered_json sizes(std::initializer_list<const char*> lengths) {
  ordered_json schema = object_schema();
  for (const char* length : lengths) add_required_quantity(schema, length, number);
  return schema;
}

ordered_json box_schema() {
  ordered_json schema = object_schema();
  add_required_quantity(schema, "size", three_numbers_schema());
  add_quantity(schema, "rounding", Quantity::length, number);
  return schema;
}

ordered_json combined_schema() {
  ordered_json part = with_required(object_schema({{"shape", shape_reference}}), {"shape"});
  add_placement(part, "parent_from_shape");
  ordered_json schema =
      with_required(object_schema({{"parts", list_schema(std::move(part), 1)}}), {"parts"});
  add_quantity(schema, "blend", Quantity::length, number);
  return schema;
}

// The one of several things that a single key names.
ordered_json one_key_schema(ordered_json properties) {
  ordered_json schema = object_schema(std::move(properties));
  std::vector<std::string> keys;
  for (const auto& [key, value] : schema["properties"].items()) keys.push_back(key);
  require_one_of(schema, keys);
  return schema;
}

ordered_json index_schema() {
  ordered_json names = ordered_json::array();
  for (const std::string_view name : synth::refractive_index_names()) names.push_back(name);
  return {{"anyOf",
           {number,
            {{"enum", names}},
            with_required(object_schema({{"eta", number}, {"k", number}}), {"eta", "k"})}}};
}

ordered_json texture_schema() {
  ordered_json picture = with_required(object_schema({{"file", text}}), {"file"});
  add_quantity(picture, "width", Quantity::length, number);
  ordered_json checker = object_schema({{"contrast", number}});
  add_quantity(checker, "period", Quantity::length, number);
  ordered_json noise = object_schema({{"octaves", {{"type", "integer"}}}, {"contrast", number}});
  add_quantity(noise, "period", Quantity::length, number);
  return one_key_schema({{"picture", picture}, {"checker", checker}, {"noise", noise}});
}

ordered_json medium_fields_schema() {
  return schema_of([](Fields& f) {
    synth::Medium medium;
    fields(f, medium);
  });
}

ordered_json gltf_schema() {
  ordered_json schema = object_schema({{"base_colour", three_numbers_schema()},
                                       {"metallic", number},
                                       {"roughness", number},
                                       {"ior", number},
                                       {"transmission", number},
                                       {"attenuation_colour", three_numbers_schema()}});
  add_quantity(schema, "attenuation_distance", Quantity::length, number);
  return with_required(object_schema({{"gltf", schema}}), {"gltf"});
}

// What a surface scatters, with its texture and, behind it, its interior.
ordered_json surface_schema(ordered_json properties) {
  properties["texture"] = texture_schema();
  properties["interior"] = medium_fields_schema();
  return object_schema(std::move(properties));
}

ordered_json faceted_schema(const char* kind, ordered_json properties = {}) {
  properties[kind] = index_schema();
  properties["roughness"] = number;
  properties["facets"] = {{"enum", {"ggx", "beckmann"}}};
  return with_required(surface_schema(std::move(properties)), {kind});
}

ordered_json matt_schema() {
  ordered_json schema = surface_schema({{"diffuse", number}});
  add_quantity(schema, "slope", Quantity::angle, number);
  return schema;
}

ordered_json material_schema() {
  return {{"oneOf",
           {matt_schema(), faceted_schema("conductor"), faceted_schema("dielectric"),
            faceted_schema("plastic", {{"diffuse", number}}), gltf_schema()}}};
}

// `geometry` holds the keys that say what form the thing has; all of them are needed.
ordered_json thing_schema(const ordered_json& geometry) {
  ordered_json schema = object_schema({{"name", text}, {"material", text}});
  for (const auto& [key, value] : geometry.items()) {
    schema["properties"][key] = value;
    require(schema, key);
  }
  add_placement(schema, "world_from_object");
  return with_required(std::move(schema), {"material"});
}

ordered_json object_in_scene_schema() {
  const ordered_json shape = {{"anyOf", {{{"enum", model_names()}}, shape_reference}}};
  return {{"oneOf",
           {thing_schema({{"shape", shape}}),
            thing_schema({{"mesh", text}, {"unit", {{"enum", mesh_unit_names()}}}})}}};
}

ordered_json light_schema() {
  ordered_json point =
      with_required(object_schema({{"intensity_w_sr", number}}), {"intensity_w_sr"});
  add_required_quantity(point, "position", three_numbers_schema());
  ordered_json area =
      with_required(object_schema({{"radiance_w_m2_sr", number}}), {"radiance_w_m2_sr"});
  add_required_quantity(area, "width", number);
  add_required_quantity(area, "height", number);
  add_placement(area, "world_from_light");
  const ordered_json environment = with_required(
      object_schema({{"radiance_w_m2_sr", number}, {"image", text}}), {"radiance_w_m2_sr"});
  return one_key_schema({{"point", point}, {"area", area}, {"environment", environment}});
}

ordered_json sight_schema(const char* how_far) {
  ordered_json schema =
      object_schema({{"mean_cosine", number}, {"single_scattering_albedo", number}});
  add_required_quantity(schema, how_far, number);
  return schema;
}

// Fog, haze, or the medium's own numbers; each with a density if it is not the same everywhere.
ordered_json medium_schema() {
  ordered_json density = with_required(object_schema({{"file", text}}), {"file"});
  add_required_quantity(density, "lowest", three_numbers_schema());
  add_required_quantity(density, "highest", three_numbers_schema());
  ordered_json fog =
      with_required(object_schema({{"fog", sight_schema("optical_range")}}), {"fog"});
  ordered_json haze =
      with_required(object_schema({{"haze", sight_schema("visibility")}}), {"haze"});
  ordered_json own = medium_fields_schema();
  for (ordered_json* kind : {&fog, &haze, &own}) (*kind)["properties"]["density"] = density;
  return {{"oneOf", {fog, haze, own, {{"type", "null"}}}}};
}

}  // namespace

ordered_json shape_schema() {
  const ordered_json combined = combined_schema();
  return one_key_schema({{"plane", object_schema()},
                         {"sphere", sizes({"radius"})},
                         {"cylinder", sizes({"radius", "height"})},
                         {"box", box_schema()},
                         {"torus", sizes({"major_radius", "minor_radius"})},
                         {"unite", combined},
                         {"intersect", combined},
                         {"subtract", combined}});
}

ordered_json scene_schema() {
  return with_required(
      object_schema(
          {{"objects", list_schema(object_in_scene_schema(), 1)},
           {"materials", {{"type", "object"}, {"additionalProperties", material_schema()}}},
           {"lights", list_schema(light_schema(), 0)},
           {"medium", medium_schema()}}),
      {"objects", "materials"});
}

}  // namespace scan
