// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/field_reader.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/core/nearest_word.h"
#include "libscan/io/shape_json.h"

namespace scan {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& words) {
  const std::string near = nearest_word(word, words);
  return near.empty() ? "" : "did you mean '" + near + "'?";
}

}  // namespace

void FieldReader::number(std::string_view key, double& value, Need need) {
  value = need == Need::required ? reader_.number(key) : reader_.number(key, value);
}

void FieldReader::integer(std::string_view key, int& value, Need need) {
  const long read = need == Need::required ? reader_.integer(key) : reader_.integer(key, value);
  if (read < std::numeric_limits<int>::min() || read > std::numeric_limits<int>::max())
    reader_.fail(key, "is " + std::to_string(read) + ", beyond any sensible size");
  value = static_cast<int>(read);
}

void FieldReader::boolean(std::string_view key, bool& value) {
  value = reader_.boolean(key, value);
}

void FieldReader::text(std::string_view key, std::string& value, Need need) {
  value = need == Need::required ? reader_.text(key) : reader_.text(key, value);
}

void FieldReader::choice(std::string_view key, int& selected,
                         const std::vector<std::string>& names) {
  const std::string word = reader_.text(key, names[static_cast<std::size_t>(selected)]);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == word) {
      selected = static_cast<int>(i);
      return;
    }
  throw Error(
      Trouble::input,
      reader_.place() + "/" + std::string(key) + ": '" + word + "' is none of " + joined(names),
      did_you_mean(word, names));
}

void FieldReader::length(std::string_view name, double& value_m, Need need) {
  value_m = need == Need::required ? reader_.length_m(name) : reader_.length_m(name, value_m);
}

void FieldReader::angle(std::string_view name, double& value_rad, Need need) {
  value_rad = need == Need::required ? reader_.angle_rad(name) : reader_.angle_rad(name, value_rad);
}

void FieldReader::time(std::string_view name, double& value_s, Need need) {
  value_s = need == Need::required ? reader_.time_s(name) : reader_.time_s(name, value_s);
}

void FieldReader::frequencies(std::string_view name, std::vector<double>& values_hz) {
  values_hz = reader_.frequencies_hz(name);
}

void FieldReader::numbers(std::string_view key, std::vector<double>& values) {
  if (reader_.has(key)) values = reader_.numbers(key);
}

void FieldReader::vector(std::string_view name, Eigen::Vector3d& value_m) {
  value_m = reader_.vector_m(name, value_m);
}

void FieldReader::direction(std::string_view key, Eigen::Vector3d& value) {
  if (!reader_.has(key)) {
    return;
  }
  const auto numbers = reader_.numbers(key);
  if (numbers.size() != 3) reader_.fail(key, "must have three numbers");
  value = {numbers[0], numbers[1], numbers[2]};
  if (!(value.norm() > 0)) reader_.fail(key, "must not be (0, 0, 0)");
  value.normalize();
}

void FieldReader::poses(std::string_view key, std::vector<Pose>& poses) {
  const nlohmann::json& list = reader_.value(key);
  if (!list.is_array()) reader_.fail(key, "must be a list of 4x4 matrices");
  poses.clear();
  for (std::size_t i = 0; i < list.size(); ++i)
    poses.push_back(pose_from_json(
        list[i], reader_.place() + "/" + std::string(key) + "/" + std::to_string(i)));
}

void FieldReader::object(std::string_view key, const std::function<void(Fields&)>& inner,
                         Need need) {
  if (need == Need::optional && !reader_.has(key)) {
    const nlohmann::json nothing = nlohmann::json::object();
    JsonReader empty(nothing, reader_.place() + "/" + std::string(key));
    FieldReader fields(empty);
    inner(fields);
    return;
  }
  JsonReader child = reader_.object(key);
  FieldReader fields(child);
  inner(fields);
  child.finish();
}

void FieldReader::one_of(const std::vector<std::string>& names, int& selected,
                         const std::function<void(int, Fields&)>& inner) {
  int found = -1;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!reader_.has(names[i])) continue;
    if (found >= 0) reader_.fail(names[i], "is one too many; exactly one of " + joined(names));
    found = static_cast<int>(i);
  }
  if (found < 0) {
    const auto keys = reader_.keys();
    for (const std::string& key : keys)
      if (const std::string hint = did_you_mean(key, names); !hint.empty())
        throw Error(Trouble::input, reader_.place() + "/" + key + ": unknown key", hint);
    throw Error(Trouble::input,
                reader_.place() + ": exactly one of " + joined(names) + " is needed");
  }
  selected = found;
  object(
      names[static_cast<std::size_t>(found)], [&](Fields& fields) { inner(found, fields); },
      Need::required);
}

}  // namespace scan
