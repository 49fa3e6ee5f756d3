// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/field_writer.h"

#include <nlohmann/json.hpp>

#include "libscan/io/shape_json.h"

namespace scan {
namespace {

std::string with(std::string_view name, const char* unit) {
  return std::string(name) + unit;
}

nlohmann::ordered_json three(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

void FieldWriter::number(std::string_view key, double& value, Need) {
  object_[std::string(key)] = value;
}
void FieldWriter::integer(std::string_view key, int& value, Need) {
  object_[std::string(key)] = value;
}
void FieldWriter::boolean(std::string_view key, bool& value) {
  object_[std::string(key)] = value;
}
void FieldWriter::text(std::string_view key, std::string& value, Need) {
  object_[std::string(key)] = value;
}
void FieldWriter::choice(std::string_view key, int& selected,
                         const std::vector<std::string>& names) {
  object_[std::string(key)] = names[static_cast<std::size_t>(selected)];
}
void FieldWriter::length(std::string_view name, double& value_m, Need) {
  object_[with(name, "_m")] = value_m;
}
void FieldWriter::angle(std::string_view name, double& value_rad, Need) {
  object_[with(name, "_rad")] = value_rad;
}
void FieldWriter::time(std::string_view name, double& value_s, Need) {
  object_[with(name, "_s")] = value_s;
}
void FieldWriter::frequencies(std::string_view name, std::vector<double>& values_hz) {
  object_[with(name, "_hz")] = values_hz;
}
void FieldWriter::numbers(std::string_view key, std::vector<double>& values) {
  object_[std::string(key)] = values;
}
void FieldWriter::vector(std::string_view name, Eigen::Vector3d& value_m) {
  object_[with(name, "_m")] = three(value_m);
}
void FieldWriter::direction(std::string_view key, Eigen::Vector3d& value) {
  object_[std::string(key)] = three(value);
}

void FieldWriter::poses(std::string_view key, std::vector<Pose>& poses) {
  auto list = nlohmann::ordered_json::array();
  for (const Pose& pose : poses) list.push_back(to_json(pose));
  object_[std::string(key)] = std::move(list);
}

void FieldWriter::object(std::string_view key, const std::function<void(Fields&)>& inner, Need) {
  nlohmann::ordered_json child = nlohmann::ordered_json::object();
  FieldWriter fields(child);
  inner(fields);
  object_[std::string(key)] = std::move(child);
}

void FieldWriter::one_of(const std::vector<std::string>& names, int& selected,
                         const std::function<void(int, Fields&)>& inner) {
  object(
      names[static_cast<std::size_t>(selected)], [&](Fields& fields) { inner(selected, fields); },
      Need::required);
}

}  // namespace scan
