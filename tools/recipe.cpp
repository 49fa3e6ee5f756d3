// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/recipe.h"

#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/json_reader.h"
#include "tools/field_reader.h"
#include "tools/field_writer.h"
#include "tools/figure_name.h"
#include "tools/recipe_fields.h"
#include "tools/study.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

// Reads one part of a recipe, from its object or, when that is missing, from nothing but defaults.
template <class Part>
void read_part(JsonReader& reader, std::string_view key, Part& part, Need need) {
  FieldReader(reader).object(
      key, [&](Fields& f) { fields(f, part); }, need);
}

template <class Part>
ordered_json write_part(Part part) {
  ordered_json object = ordered_json::object();
  FieldWriter writer(object);
  fields(writer, part);
  return object;
}

synth::EffectChoice read_effects(JsonReader& reader) {
  using Kind = synth::EffectChoice::Kind;
  if (!reader.has("effects")) return {};
  const nlohmann::json& value = reader.value("effects");
  if (value == "auto") return {Kind::automatic, {}};
  if (value == "all") return {Kind::all, {}};
  if (value == "none") return {Kind::none, {}};
  const bool list = value.is_array() && std::all_of(value.begin(), value.end(),
                                                    [](const auto& e) { return e.is_string(); });
  if (!list) reader.fail("effects", "must be \"auto\", \"all\", \"none\" or a list of effects");
  return {Kind::named, value.get<std::vector<std::string>>()};
}

ordered_json to_json(const synth::EffectChoice& choice) {
  using Kind = synth::EffectChoice::Kind;
  switch (choice.kind) {
    case Kind::automatic:
      return "auto";
    case Kind::all:
      return "all";
    case Kind::none:
      return "none";
    case Kind::named:
      break;
  }
  return choice.names;
}

// "at_most_mm", "at_least", "equals": the relation, then the unit that the figure has.
Limit read_limit(JsonReader reader) {
  Limit limit{.name = read_figure(reader, "name"), .relation = "", .value = 0, .reason = ""};
  for (const auto& [word, relation] :
       {std::pair("at_most", "<="), std::pair("at_least", ">="), std::pair("equals", "==")}) {
    double value = 0;
    if (reader.has(word))
      value = reader.number(word);
    else if (reader.has(std::string(word) + "_deg") || reader.has(std::string(word) + "_rad"))
      value = reader.angle_rad(word);
    else if (reader.has_quantity(word))
      value = reader.length_m(word);
    else
      continue;
    if (!limit.relation.empty()) reader.fail(word, "is a second limit; one limit an entry");
    limit.relation = relation;
    limit.value = value;
  }
  if (limit.relation.empty())
    reader.fail("name", "has no at_most, at_least or equals (with the unit: at_most_mm)");
  limit.reason = reader.text("reason");
  reader.finish();
  return limit;
}

std::vector<Limit> read_limits(JsonReader& reader, const char* key) {
  std::vector<Limit> limits;
  if (reader.has(key))
    for (JsonReader& limit : reader.objects(key)) limits.push_back(read_limit(std::move(limit)));
  return limits;
}

ordered_json to_json(const Limit& limit, const std::string& unit) {
  const std::string word = limit.relation == "<="   ? "at_most"
                           : limit.relation == ">=" ? "at_least"
                                                    : "equals";
  return {{"name", limit.name}, {word + unit, limit.value}, {"reason", limit.reason}};
}

// The unit's suffix of a figure, by its name.
std::string unit_suffix(const std::string& name) {
  for (const char* angle : {"normal_error", "rotation_error", "cylinder_axis_error"})
    if (name.find(angle) != std::string::npos) return "_rad";
  for (const char* count :
       {"components", "boundary_edges", "non_manifold_edges", "genus", "self_intersections",
        "f_score", "ray_hit_fraction", "unsupported_area", "area_error", "volume_error"})
    if (name == count) return "";
  if (name.starts_with("normalised_") || name.ends_with("_within_95")) return "";
  return "_m";
}

ordered_json to_json(const std::vector<Limit>& limits) {
  ordered_json list = ordered_json::array();
  for (const Limit& limit : limits) list.push_back(to_json(limit, unit_suffix(limit.name)));
  return list;
}

void check_settings(const Recipe& recipe, const std::string& place) {
  try {
    check(recipe.scanner);
    check(recipe.viewpoints);
    check(recipe.align.icp);
    check(recipe.reconstruct.ssd);
    check(recipe.effects);
    if (recipe.artefacts) check(*recipe.artefacts);
    check_standing(recipe.scene.scene, true_poses(recipe.viewpoints));
  } catch (const Error& error) {
    throw Error(Trouble::input, place + ": " + error.what(), error.hint());
  }
}

}  // namespace

Recipe read_recipe(const std::filesystem::path& path) {
  return read_recipe(read_json(path), path.string(), path.parent_path());
}

Recipe read_recipe(const nlohmann::json& json, const std::string& place,
                   const std::filesystem::path& folder) {
  JsonReader reader(json, place);
  const long version = reader.integer("libscan");
  if (version != recipe_version)
    reader.fail("libscan", "is " + std::to_string(version) + ", this program reads version 1");
  Recipe recipe;
  recipe.name = reader.text("name", std::filesystem::path(place).stem().string());
  const long seed = reader.integer("seed", 1);
  if (seed < 0) reader.fail("seed", "is " + std::to_string(seed) + ", must not be negative");
  recipe.seed = static_cast<std::uint64_t>(seed);
  read_part(reader, "scanner", recipe.scanner, Need::required);
  recipe.scene = read_scene(reader.object("scene"), folder, synth::wavelength_m(recipe.scanner));
  read_part(reader, "viewpoints", recipe.viewpoints, Need::required);
  recipe.effects = read_effects(reader);
  read_part(reader, "acquire", recipe.acquire, Need::optional);
  read_part(reader, "align", recipe.align, Need::optional);
  read_part(reader, "reconstruct", recipe.reconstruct, Need::optional);
  read_part(reader, "verify", recipe.verify, Need::optional);
  if (reader.has("artefacts"))
    read_part(reader, "artefacts", recipe.artefacts.emplace(), Need::required);
  recipe.artefact_limits = read_limits(reader, "artefact_limits");
  recipe.limits = read_limits(reader, "limits");
  (void)reader.text("about", "");
  if (reader.has("tradeoff")) (void)read_study(reader.object("tradeoff"));
  reader.finish();
  check_settings(recipe, place);
  return recipe;
}

std::vector<Limit> read_limits(const std::filesystem::path& path) {
  const nlohmann::json json = read_json(path);
  if (!json.is_array())
    throw Error(Trouble::input, path.string() + ": must be a list of limits [ {...}, ... ]");
  std::vector<Limit> limits;
  for (std::size_t i = 0; i < json.size(); ++i)
    limits.push_back(read_limit(JsonReader(json[i], path.string() + "/" + std::to_string(i))));
  return limits;
}

ordered_json to_json(const Recipe& recipe) {
  ordered_json json = {{"libscan", recipe_version},
                       {"name", recipe.name},
                       {"seed", recipe.seed},
                       {"scene", to_json(recipe.scene)},
                       {"scanner", write_part(recipe.scanner)},
                       {"viewpoints", write_part(recipe.viewpoints)},
                       {"effects", to_json(recipe.effects)},
                       {"acquire", write_part(recipe.acquire)},
                       {"align", write_part(recipe.align)},
                       {"reconstruct", write_part(recipe.reconstruct)},
                       {"verify", write_part(recipe.verify)},
                       {"limits", to_json(recipe.limits)}};
  if (recipe.artefacts) json["artefacts"] = write_part(*recipe.artefacts);
  if (!recipe.artefact_limits.empty()) json["artefact_limits"] = to_json(recipe.artefact_limits);
  return json;
}

}  // namespace scan
