// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/recipe_lights.h"

#include <nlohmann/json.hpp>

#include "libscan/io/image_file.h"
#include "libscan/io/shape_json.h"
#include "tools/field_reader.h"
#include "tools/field_writer.h"
#include "tools/recipe_materials.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

std::filesystem::path file_at(JsonReader& reader, std::string_view key,
                              const std::filesystem::path& folder) {
  return std::filesystem::absolute(folder / reader.text(key)).lexically_normal();
}

synth::PointLight read_point(JsonReader reader) {
  const synth::PointLight light{.position_m = reader.vector_m("position"),
                                .intensity_w_sr = reader.number("intensity_w_sr")};
  reader.finish();
  return light;
}

synth::AreaLight read_area(JsonReader reader) {
  synth::AreaLight light;
  light.width_m = reader.length_m("width");
  light.height_m = reader.length_m("height");
  light.radiance_w_m2_sr = reader.number("radiance_w_m2_sr");
  light.world_from_light =
      reader.has("world_from_light")
          ? pose_from_json(reader.value("world_from_light"), reader.place() + "/world_from_light")
          : reader.placement();
  reader.finish();
  return light;
}

RecipeLight read_environment(JsonReader reader, const std::filesystem::path& folder) {
  synth::Environment light{.radiance_w_m2_sr = reader.number("radiance_w_m2_sr"), .map = {}};
  std::filesystem::path image;
  if (reader.has("image")) {
    image = file_at(reader, "image", folder);
    light.map = read_float_image(image);
  }
  reader.finish();
  return {std::move(light), image};
}

struct LightWriter {
  const std::filesystem::path& image;
  ordered_json operator()(const synth::PointLight& l) const {
    const Eigen::Vector3d& p = l.position_m;
    return {
        {"point", {{"position_m", {p.x(), p.y(), p.z()}}, {"intensity_w_sr", l.intensity_w_sr}}}};
  }
  ordered_json operator()(const synth::AreaLight& l) const {
    return {{"area",
             {{"width_m", l.width_m},
              {"height_m", l.height_m},
              {"radiance_w_m2_sr", l.radiance_w_m2_sr},
              {"world_from_light", to_json(l.world_from_light)}}}};
  }
  ordered_json operator()(const synth::Environment& l) const {
    ordered_json inner = {{"radiance_w_m2_sr", l.radiance_w_m2_sr}};
    if (!image.empty()) inner["image"] = image.string();
    return {{"environment", inner}};
  }
};

synth::DensityGrid read_density(JsonReader reader, const std::filesystem::path& folder,
                                std::filesystem::path& file) {
  file = file_at(reader, "file", folder);
  const NumberArray array = read_npy(file);
  if (array.shape.size() != 3)
    reader.fail("file", file.string() + " has " + std::to_string(array.shape.size()) +
                            " dimensions, must have 3");
  synth::DensityGrid grid;
  grid.box_m = {reader.vector_m("lowest"), reader.vector_m("highest")};
  for (int axis = 0; axis < 3; ++axis) grid.cells[axis] = static_cast<int>(array.shape[2 - axis]);
  grid.density.assign(array.values.begin(), array.values.end());
  reader.finish();
  return grid;
}

}  // namespace

RecipeLight read_light(JsonReader reader, const std::filesystem::path& folder) {
  RecipeLight light;
  const std::string kind = reader.one_of({"point", "area", "environment"});
  if (kind == "point") light.light = read_point(reader.object(kind));
  if (kind == "area") light.light = read_area(reader.object(kind));
  if (kind == "environment") light = read_environment(reader.object(kind), folder);
  reader.finish();
  return light;
}

ordered_json to_json(const RecipeLight& light) {
  return std::visit(LightWriter{light.image}, light.light);
}

RecipeMedium read_medium(JsonReader reader, const std::filesystem::path& folder) {
  RecipeMedium read;
  if (reader.has("fog")) {
    JsonReader inner = reader.object("fog");
    const double range_m = inner.length_m("optical_range");
    const double cosine = inner.number("mean_cosine", 0.9);
    read.medium = synth::fog(range_m, cosine, inner.number("single_scattering_albedo", 1));
    inner.finish();
  } else {
    FieldReader inner(reader);
    fields(inner, read.medium);
  }
  if (reader.has("density"))
    read.medium.density = read_density(reader.object("density"), folder, read.density);
  reader.finish();
  return read;
}

ordered_json to_json(const RecipeMedium& given) {
  ordered_json json = ordered_json::object();
  FieldWriter writer(json);
  synth::Medium medium = given.medium;
  fields(writer, medium);
  if (const auto* grid = std::get_if<synth::DensityGrid>(&medium.density)) {
    const Eigen::Vector3d &low = grid->box_m.min(), &high = grid->box_m.max();
    json["density"] = {{"file", given.density.string()},
                       {"lowest_m", {low.x(), low.y(), low.z()}},
                       {"highest_m", {high.x(), high.y(), high.z()}}};
  }
  return json;
}

}  // namespace scan
