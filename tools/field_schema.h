// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Fields described as JSON Schema (draft 2020-12): the same list of keys that reads a recipe tells
// an editor what may stand in it.
#pragma once

#include <nlohmann/json.hpp>

#include "libscan/io/json_reader.h"
#include "tools/fields.h"

namespace scan {

class FieldSchema : public Fields {
 public:
  // Adds to the object schema `schema`, which must outlive this. `required` is what required
  // numbers are said to be while the keys behind them are described.
  FieldSchema(nlohmann::ordered_json& schema, int required)
      : schema_(schema), required_(required) {}
  void number(std::string_view key, double& value, Need need) override;
  void integer(std::string_view key, int& value, Need need) override;
  void boolean(std::string_view key, bool& value) override;
  void text(std::string_view key, std::string& value, Need need) override;
  void choice(std::string_view key, int& selected, const std::vector<std::string>& names) override;
  void length(std::string_view name, double& value_m, Need need) override;
  void angle(std::string_view name, double& value_rad, Need need) override;
  void time(std::string_view name, double& value_s, Need need) override;
  void frequencies(std::string_view name, std::vector<double>& values_hz) override;
  void numbers(std::string_view key, std::vector<double>& values) override;
  void vector(std::string_view name, Eigen::Vector3d& value_m) override;
  void direction(std::string_view key, Eigen::Vector3d& value) override;
  void poses(std::string_view key, std::vector<Pose>& poses) override;
  void object(std::string_view key, const std::function<void(Fields&)>& inner, Need need) override;
  void one_of(const std::vector<std::string>& names, int& selected,
              const std::function<void(int, Fields&)>& inner) override;
  std::string place() const override { return "schema"; }

 private:
  void quantity(std::string_view name, Quantity quantity, double& value, Need need);

  nlohmann::ordered_json& schema_;
  int required_;
};

// The schema of an object that `describe` gives the keys of. A default that depends on a required
// value, such as an image's middle, is left out.
nlohmann::ordered_json schema_of(const std::function<void(Fields&)>& describe);

// Pieces for what is not read by Fields. A property is optional unless `require` names it.
nlohmann::ordered_json object_schema(nlohmann::ordered_json properties = {});
void add_quantity(nlohmann::ordered_json& schema, std::string_view name, Quantity quantity,
                  const nlohmann::ordered_json& values);
void require(nlohmann::ordered_json& schema, std::string_view key);
// One of these keys, or lists of keys, must be there, and only one.
void require_one_of(nlohmann::ordered_json& schema, const std::vector<std::string>& keys);
nlohmann::ordered_json list_schema(nlohmann::ordered_json items, int least);
nlohmann::ordered_json three_numbers_schema();
nlohmann::ordered_json matrix_schema();

}  // namespace scan
