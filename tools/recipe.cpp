// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/recipe.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "libscan/core/error.h"
#include "libscan/io/json_reader.h"
#include "libscan/io/json_units.h"
#include "tools/field_reader.h"
#include "tools/field_writer.h"
#include "tools/figure_name.h"
#include "tools/recipe_check.h"
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

// The unit that a figure's limit carries in its key, SI: "_m", "_rad" or none.
std::string unit_suffix(const std::string& name) {
  const std::string unit = figure_definition(name)->unit;
  return unit == "m" || unit == "rad" ? "_" + unit : "";
}

// The number of a limit whose key is the word and a unit: "at_most_mm" of a length, "at_most_deg"
// of an angle, "at_most" of anything else. None if there is no such key.
std::optional<double> read_bound(JsonReader& reader, const std::string& word,
                                 const std::string& figure) {
  const std::string unit = unit_suffix(figure);
  const auto known = unit == "_m"     ? unit_suffixes(Quantity::length)
                     : unit == "_rad" ? unit_suffixes(Quantity::angle)
                                      : std::vector<std::string>{""};
  for (const std::string& key : reader.keys()) {
    if (key != word && !key.starts_with(word + "_")) continue;
    if (std::find(known.begin(), known.end(), key.substr(word.size())) == known.end())
      reader.fail(key, "'" + figure + "' is " +
                           (unit == "_m"     ? "a length: " + word + "_mm or such"
                            : unit == "_rad" ? "an angle: " + word + "_deg or such"
                                             : "without a unit: " + word));
    return unit == "_m"     ? reader.length_m(word)
           : unit == "_rad" ? reader.angle_rad(word)
                            : reader.number(word);
  }
  return std::nullopt;
}

Limit read_limit(JsonReader reader, FigureSource source) {
  Limit limit{
      .name = read_figure(reader, "name", source), .relation = "", .value = 0, .reason = ""};
  for (const auto& [word, relation] : limit_words) {
    const auto bound = read_bound(reader, word, limit.name);
    if (!bound) continue;
    if (!limit.relation.empty()) reader.fail(word, "is a second limit; one limit an entry");
    limit.relation = relation;
    limit.value = *bound;
  }
  if (limit.relation.empty())
    reader.fail("name", "has no at_most, at_least, equals or within (with the unit: at_most_mm)");
  limit.reason = reader.text("reason");
  reader.finish();
  return limit;
}

std::vector<Limit> read_limits(JsonReader& reader, const char* key, FigureSource source) {
  std::vector<Limit> limits;
  if (reader.has(key))
    for (JsonReader& limit : reader.objects(key))
      limits.push_back(read_limit(std::move(limit), source));
  return limits;
}

ordered_json to_json(const Limit& limit, const std::string& unit) {
  std::string key;
  for (const auto& [word, relation] : limit_words)
    if (limit.relation == relation) key = word + unit;
  return {{"name", limit.name}, {key, limit.value}, {"reason", limit.reason}};
}

ordered_json to_json(const std::vector<Limit>& limits) {
  ordered_json list = ordered_json::array();
  for (const Limit& limit : limits) list.push_back(to_json(limit, unit_suffix(limit.name)));
  return list;
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
  recipe.artefact_limits = read_limits(reader, "artefact_limits", FigureSource::artefact);
  recipe.limits = read_limits(reader, "limits", FigureSource::surface_or_run);
  (void)reader.text("about", "");
  if (reader.has("tradeoff")) (void)read_study(reader.object("tradeoff"));
  reader.finish();
  check_settings(recipe, place);
  return recipe;
}

std::vector<Limit> read_limits(const std::filesystem::path& path, FigureSource source) {
  const nlohmann::json json = read_json(path);
  if (!json.is_array())
    throw Error(Trouble::input, path.string() + ": must be a list of limits [ {...}, ... ]");
  std::vector<Limit> limits;
  for (std::size_t i = 0; i < json.size(); ++i)
    limits.push_back(
        read_limit(JsonReader(json[i], path.string() + "/" + std::to_string(i)), source));
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
