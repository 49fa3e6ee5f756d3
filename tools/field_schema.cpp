// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/field_schema.h"

#include <cmath>

namespace scan {
namespace {

using nlohmann::ordered_json;

ordered_json typed(const char* type) {
  return {{"type", type}};
}

// JSON has no infinity: a limit that is none by default has no default to show.
ordered_json with_default(ordered_json schema, double value) {
  if (std::isfinite(value)) schema["default"] = value;
  return schema;
}

std::vector<std::string> with_units(std::string_view name, Quantity quantity) {
  std::vector<std::string> keys;
  for (const std::string& suffix : unit_suffixes(quantity))
    keys.push_back(std::string(name) + suffix);
  return keys;
}

// Leaves out of `schema` every default that `other`, the same schema otherwise, has another of.
void keep_common_defaults(ordered_json& schema, const ordered_json& other) {
  if (!schema.is_structured()) return;
  if (schema.is_object() && schema.contains("default") && schema["default"] != other["default"])
    schema.erase("default");
  for (auto item = schema.begin(); item != schema.end(); ++item)
    keep_common_defaults(*item, schema.is_object()
                                    ? other[item.key()]
                                    : other[static_cast<std::size_t>(item - schema.begin())]);
}

}  // namespace

ordered_json object_schema(ordered_json properties) {
  if (properties.is_null()) properties = ordered_json::object();
  return {
      {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

void require(ordered_json& schema, std::string_view key) {
  schema["required"].push_back(key);
}

void require_one_of(ordered_json& schema, const std::vector<std::string>& keys) {
  ordered_json ways = ordered_json::array();
  for (const std::string& key : keys) ways.push_back({{"required", {key}}});
  schema["allOf"].push_back({{"oneOf", std::move(ways)}});
}

void add_quantity(ordered_json& schema, std::string_view name, Quantity quantity,
                  const ordered_json& values) {
  for (const std::string& key : with_units(name, quantity)) schema["properties"][key] = values;
}

ordered_json list_schema(ordered_json items, int least) {
  return {{"type", "array"}, {"items", std::move(items)}, {"minItems", least}};
}

ordered_json three_numbers_schema() {
  ordered_json three = list_schema(typed("number"), 3);
  three["maxItems"] = 3;
  return three;
}

ordered_json matrix_schema() {
  ordered_json row = list_schema(typed("number"), 4);
  row["maxItems"] = 4;
  ordered_json matrix = list_schema(std::move(row), 4);
  matrix["maxItems"] = 4;
  return matrix;
}

void FieldSchema::number(std::string_view key, double& value, Need need) {
  if (need == Need::required) {
    value = required_;
    require(schema_, key);
  }
  ordered_json schema = typed("number");
  schema_["properties"][std::string(key)] =
      need == Need::required ? schema : with_default(schema, value);
}

void FieldSchema::integer(std::string_view key, int& value, Need need) {
  ordered_json schema = typed("integer");
  if (need == Need::required) {
    value = required_;
    require(schema_, key);
  } else {
    schema["default"] = value;
  }
  schema_["properties"][std::string(key)] = std::move(schema);
}

void FieldSchema::boolean(std::string_view key, bool& value) {
  schema_["properties"][std::string(key)] = {{"type", "boolean"}, {"default", value}};
}

void FieldSchema::text(std::string_view key, std::string&, Need need) {
  schema_["properties"][std::string(key)] = typed("string");
  if (need == Need::required) require(schema_, key);
}

void FieldSchema::choice(std::string_view key, int& selected,
                         const std::vector<std::string>& names) {
  schema_["properties"][std::string(key)] = {
      {"enum", names}, {"default", names[static_cast<std::size_t>(selected)]}};
}

// The default is told in SI, as recipes are written back.
void FieldSchema::quantity(std::string_view name, Quantity quantity, double& value, Need need) {
  add_quantity(schema_, name, quantity, typed("number"));
  if (need == Need::required) {
    value = required_;
    require_one_of(schema_, with_units(name, quantity));
    return;
  }
  ordered_json& in_si = schema_["properties"][with_units(name, quantity).front()];
  in_si = with_default(in_si, value);
}

void FieldSchema::length(std::string_view name, double& value_m, Need need) {
  quantity(name, Quantity::length, value_m, need);
}

void FieldSchema::angle(std::string_view name, double& value_rad, Need need) {
  quantity(name, Quantity::angle, value_rad, need);
}

void FieldSchema::time(std::string_view name, double& value_s, Need need) {
  quantity(name, Quantity::time, value_s, need);
}

void FieldSchema::frequencies(std::string_view name, std::vector<double>&) {
  add_quantity(schema_, name, Quantity::frequency, list_schema(typed("number"), 1));
  require_one_of(schema_, with_units(name, Quantity::frequency));
}

void FieldSchema::numbers(std::string_view key, std::vector<double>& values) {
  schema_["properties"][std::string(key)] = list_schema(typed("number"), 0);
  schema_["properties"][std::string(key)]["default"] = values;
}

void FieldSchema::vector(std::string_view name, Eigen::Vector3d& value_m) {
  add_quantity(schema_, name, Quantity::length, three_numbers_schema());
  schema_["properties"][with_units(name, Quantity::length).front()]["default"] = {
      value_m.x(), value_m.y(), value_m.z()};
}

void FieldSchema::direction(std::string_view key, Eigen::Vector3d& value) {
  schema_["properties"][std::string(key)] = three_numbers_schema();
  schema_["properties"][std::string(key)]["default"] = {value.x(), value.y(), value.z()};
}

void FieldSchema::poses(std::string_view key, std::vector<Pose>&) {
  schema_["properties"][std::string(key)] = list_schema(matrix_schema(), 0);
  require(schema_, key);
}

void FieldSchema::object(std::string_view key, const std::function<void(Fields&)>& inner,
                         Need need) {
  ordered_json child = object_schema();
  FieldSchema fields(child, required_);
  inner(fields);
  schema_["properties"][std::string(key)] = std::move(child);
  if (need == Need::required) require(schema_, key);
}

void FieldSchema::one_of(const std::vector<std::string>& names, int& selected,
                         const std::function<void(int, Fields&)>& inner) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    selected = static_cast<int>(i);
    object(
        names[i], [&](Fields& fields) { inner(selected, fields); }, Need::optional);
  }
  require_one_of(schema_, names);
}

ordered_json schema_of(const std::function<void(Fields&)>& describe) {
  std::array<ordered_json, 2> schemas = {object_schema(), object_schema()};
  for (const int i : {0, 1}) {
    FieldSchema fields(schemas[static_cast<std::size_t>(i)], 2 + 2 * i);
    describe(fields);
  }
  keep_common_defaults(schemas[0], schemas[1]);
  return schemas[0];
}

}  // namespace scan
