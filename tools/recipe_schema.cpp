// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/recipe_schema.h"

#include "tools/field_schema.h"
#include "tools/figure_name.h"
#include "tools/recipe_fields.h"
#include "tools/scene_schema.h"
#include "tools/study.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

const ordered_json text = {{"type", "string"}};

template <class Part>
ordered_json part_schema() {
  return schema_of([](Fields& f) {
    Part part;
    fields(f, part);
  });
}

ordered_json effects_schema() {
  return {{"anyOf", {{{"enum", {"auto", "all", "none"}}}, list_schema(text, 0)}},
          {"default", "auto"}};
}

// at_most_mm, at_least_rad, equals, ...: one relation with the figure's unit.
ordered_json limit_schema() {
  ordered_json schema = object_schema({{"name", text}, {"reason", text}});
  require(schema, "name");
  require(schema, "reason");
  std::vector<std::string> relations;
  for (const auto& [word, relation] : limit_words) {
    relations.emplace_back(word);
    for (const Quantity quantity : {Quantity::length, Quantity::angle})
      for (const std::string& unit : unit_suffixes(quantity)) relations.push_back(word + unit);
  }
  for (const std::string& relation : relations)
    schema["properties"][relation] = {{"type", "number"}};
  require_one_of(schema, relations);
  return schema;
}

ordered_json named_fields_schema() {
  ordered_json schema =
      object_schema({{"name", text}, {"set", {{"type", "object"}, {"minProperties", 1}}}});
  require(schema, "name");
  require(schema, "set");
  return schema;
}

ordered_json variation_schema() {
  ordered_json field =
      object_schema({{"key", text}, {"values", list_schema(ordered_json::object(), 1)}});
  require(field, "key");
  require(field, "values");
  ordered_json choices =
      object_schema({{"name", text}, {"choices", list_schema(named_fields_schema(), 1)}});
  require(choices, "name");
  require(choices, "choices");
  return {{"oneOf", {field, choices}}};
}

ordered_json study_schema() {
  const Study study;
  ordered_json schema = object_schema(
      {{"vary", list_schema(variation_schema(), 1)},
       {"cases", list_schema(named_fields_schema(), 1)},
       {"seeds",
        {{"type", "integer"}, {"minimum", 1}, {"maximum", 1000}, {"default", study.seeds}}},
       {"error", {{"type", "string"}, {"default", study.error}}},
       {"seconds", {{"enum", timed_stages()}, {"default", study.seconds}}},
       {"clock", {{"enum", study_clocks()}, {"default", study.clock}}}});
  require(schema, "vary");
  return schema;
}

}  // namespace

ordered_json recipe_schema() {
  const ordered_json limits = list_schema(limit_schema(), 0);
  ordered_json schema =
      object_schema({{"libscan", {{"const", recipe_version}}},
                     {"name", text},
                     {"about", text},
                     {"seed", {{"type", "integer"}, {"minimum", 0}, {"default", Recipe().seed}}},
                     {"scene", scene_schema()},
                     {"scanner", part_schema<synth::Scanner>()},
                     {"viewpoints", part_schema<synth::Viewpoints>()},
                     {"effects", effects_schema()},
                     {"acquire", part_schema<AcquireOptions>()},
                     {"align", part_schema<MultiviewOptions>()},
                     {"reconstruct", part_schema<ReconstructSettings>()},
                     {"verify", part_schema<VerifySettings>()},
                     {"artefacts", part_schema<synth::Artefacts>()},
                     {"artefact_limits", limits},
                     {"limits", limits},
                     {"tradeoff", study_schema()}});
  for (const char* key : {"libscan", "scene", "scanner", "viewpoints"}) require(schema, key);
  schema["$defs"] = {{"shape", shape_schema()}};
  ordered_json whole = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                        {"title", "libscan recipe"}};
  whole.update(schema);
  return whole;
}

}  // namespace scan
