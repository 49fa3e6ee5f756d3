// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// As much of JSON Schema as the recipe's needs: what breaks it, and values that keep it.
#pragma once

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace scan::test {

using nlohmann::json;

inline const json& resolved(const json& schema, const json& root) {
  if (!schema.contains("$ref")) return schema;
  return root.at(json::json_pointer(schema["$ref"].get<std::string>().substr(1)));
}

inline bool has_type(const json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  return type == "null" && value.is_null();
}

std::string broken(const json& schema, const json& value, const json& root);

inline int kept(const json& schemas, const json& value, const json& root) {
  return static_cast<int>(std::count_if(schemas.begin(), schemas.end(), [&](const json& s) {
    return broken(s, value, root).empty();
  }));
}

inline std::string broken_object(const json& schema, const json& value, const json& root) {
  for (const json& key : schema.value("required", json::array()))
    if (!value.contains(key.get<std::string>())) return "lacks " + key.get<std::string>();
  const json properties = schema.value("properties", json::object());
  const json rest = schema.value("additionalProperties", json(true));
  for (const auto& [key, inner] : value.items()) {
    if (!properties.contains(key) && rest == false) return "has " + key;
    const json* of_key = properties.contains(key) ? &properties[key] : &rest;
    if (!of_key->is_object()) continue;
    if (const std::string why = broken(*of_key, inner, root); !why.empty()) return key + ": " + why;
  }
  return value.size() < schema.value("minProperties", 0u) ? "is too small" : "";
}

inline std::string broken_list(const json& schema, const json& value, const json& root) {
  if (value.size() < schema.value("minItems", 0u)) return "is too short";
  if (schema.contains("maxItems") && value.size() > schema["maxItems"]) return "is too long";
  for (const json& item : value)
    if (const std::string why = broken(schema.at("items"), item, root); !why.empty()) return why;
  return "";
}

// Why the value breaks the schema; empty if it keeps it.
inline std::string broken(const json& reference, const json& value, const json& root) {
  const json& schema = resolved(reference, root);
  if (schema.contains("const") && schema["const"] != value) return "is another constant";
  if (schema.contains("enum")) {
    const json& words = schema["enum"];
    if (std::find(words.begin(), words.end(), value) == words.end()) return "is none of the words";
  }
  if (schema.contains("type") && !has_type(value, schema["type"]))
    return "must be of type " + schema["type"].get<std::string>();
  if (schema.contains("minimum") && value < schema["minimum"]) return "is too small";
  if (schema.contains("maximum") && value > schema["maximum"]) return "is too large";
  if (schema.contains("oneOf") && kept(schema["oneOf"], value, root) != 1)
    return "is not one of the ways";
  if (schema.contains("anyOf") && kept(schema["anyOf"], value, root) == 0)
    return "is none of the ways";
  for (const json& part : schema.value("allOf", json::array()))
    if (const std::string why = broken(part, value, root); !why.empty()) return why;
  if (value.is_object()) return broken_object(schema, value, root);
  return value.is_array() && schema.contains("items") ? broken_list(schema, value, root) : "";
}

// The keys that `schema` wants exactly one of, group by group.
inline std::vector<std::vector<std::string>> groups_of(const json& schema) {
  std::vector<std::vector<std::string>> groups;
  for (const json& part : schema.value("allOf", json::array())) {
    groups.emplace_back();
    for (const json& way : part.at("oneOf")) groups.back().push_back(way.at("required").at(0));
  }
  return groups;
}

// A value that keeps the schema with as few keys as can be, and more of them that together hold
// every key, word and way of it at least once. Schemas behind a second "$ref" are not varied.
struct Values {
  json least;
  std::vector<json> more;
};

Values values_of(const json& schema, const json& root, int references = 0);

inline void add_with(std::vector<json>& list, json object, const std::string& key,
                     const Values& values, const std::vector<std::vector<std::string>>& groups) {
  for (const auto& group : groups)
    if (std::find(group.begin(), group.end(), key) != group.end())
      for (const std::string& other : group) object.erase(other);
  object[key] = values.least;
  list.push_back(object);
  for (const json& value : values.more) {
    object[key] = value;
    list.push_back(object);
  }
}

inline Values values_of_object(const json& schema, const json& root, int references) {
  const auto groups = groups_of(schema);
  const json properties = schema.value("properties", json::object());
  std::map<std::string, Values> inner;
  for (const auto& [key, property] : properties.items())
    inner[key] = values_of(property, root, references);
  Values values{json::object(), {}};
  for (const json& key : schema.value("required", json::array()))
    values.least[key.get<std::string>()] = inner.at(key).least;
  for (const auto& group : groups) values.least[group.front()] = inner.at(group.front()).least;
  if (values.least.size() < schema.value("minProperties", 0u)) values.least["clay"] = 1;
  for (const auto& [key, property] : properties.items())
    add_with(values.more, values.least, key, inner.at(key), groups);
  if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object())
    add_with(values.more, values.least, "clay",
             values_of(schema["additionalProperties"], root, references), {});
  return values;
}

inline Values values_of_ways(const json& ways, const json& root, int references) {
  Values values = values_of(ways.front(), root, references);
  for (std::size_t i = 1; i < ways.size(); ++i) {
    const Values other = values_of(ways[i], root, references);
    values.more.push_back(other.least);
    values.more.insert(values.more.end(), other.more.begin(), other.more.end());
  }
  return values;
}

inline Values values_of(const json& reference, const json& root, int references) {
  references += reference.contains("$ref") ? 1 : 0;
  const json& schema = resolved(reference, root);
  for (const char* ways : {"oneOf", "anyOf"})
    if (schema.contains(ways)) return values_of_ways(schema[ways], root, references);
  if (schema.contains("const")) return {schema["const"], {}};
  if (schema.contains("enum")) {
    std::vector<json> words = schema["enum"];
    return {words.front(), {words.begin() + 1, words.end()}};
  }
  const std::string type = schema.value("type", "string");
  if (type == "object") {
    if (references <= 2) return values_of_object(schema, root, references);
    return {json{{groups_of(schema).front().front(), json::object()}}, {}};
  }
  if (type == "array") {
    const Values items = values_of(schema.at("items"), root, references);
    const auto least = std::max<std::size_t>(1, schema.value("minItems", 0u));
    Values lists{json(std::vector<json>(least, items.least)), {}};
    for (const json& item : items.more) lists.more.push_back(std::vector<json>(least, item));
    return lists;
  }
  if (schema.contains("default")) return {schema["default"], {}};
  if (type == "string") return {"clay", {}};
  if (type == "boolean") return {true, {}};
  if (type == "null") return {nullptr, {}};
  return {1, {}};
}

}  // namespace scan::test
