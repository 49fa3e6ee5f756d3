// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/json_reader.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "libscan/core/error.h"
#include "libscan/core/nearest_word.h"
#include "libscan/core/units.h"

namespace scan {
namespace {

using nlohmann::json;

using Units = JsonUnits;

// A value as a message shows it.
std::string shown(const json& value) {
  const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

std::string listed(std::string_view name, const Units& units) {
  std::string text;
  for (const auto& [suffix, scale] : units)
    text += (text.empty() ? "" : ", ") + std::string(name) + suffix;
  return text;
}

}  // namespace

JsonReader::JsonReader(const json& object, std::string place)
    : object_(&object), place_(std::move(place)) {
  if (!object.is_object())
    throw Error(Trouble::input,
                place_ + ": must be an object { ... }, is " + std::string(object.type_name()));
}

void JsonReader::fail(std::string_view key, const std::string& what) const {
  throw Error(Trouble::input, place_ + "/" + std::string(key) + ": " + what);
}

// A key that nobody has asked for and that reads nearly like the missing one is what was meant.
void JsonReader::fail_missing(std::string_view name, const Units& units) const {
  std::vector<std::string> meant;
  for (const auto& [suffix, scale] : units) meant.push_back(std::string(name) + suffix);
  if (meant.empty()) meant.emplace_back(name);
  const std::string alternatives = units.empty() ? "" : " (one of " + listed(name, units) + ")";
  std::string hint;
  for (const std::string& key : keys()) {
    const std::string near = known_.contains(key) ? "" : nearest_word(key, meant);
    if (!near.empty()) hint = "did you mean '" + near + "' by '" + key + "'?";
  }
  throw Error(Trouble::input, place_ + "/" + std::string(name) + ": is missing" + alternatives,
              hint);
}

std::string JsonReader::one_of(const std::vector<std::string>& words) {
  std::string found, list;
  for (const std::string& word : words) {
    list += (list.empty() ? "" : ", ") + word;
    if (!has(word)) continue;
    if (!found.empty()) fail(word, "stands beside '" + found + "'; only one of them can be");
    found = word;
  }
  if (!found.empty()) return found;
  std::string hint;
  for (const std::string& key : keys())
    if (const std::string near = nearest_word(key, words); !near.empty())
      hint = "did you mean '" + near + "' by '" + key + "'?";
  throw Error(Trouble::input, place_ + ": must have one of " + list, hint);
}

const json* JsonReader::find(std::string_view key) {
  known_.emplace(key);
  const auto found = object_->find(std::string(key));
  return found == object_->end() ? nullptr : &*found;
}

bool JsonReader::has(std::string_view key) {
  return find(key) != nullptr;
}

bool JsonReader::has_quantity(std::string_view name) const {
  for (const Quantity quantity :
       {Quantity::length, Quantity::angle, Quantity::time, Quantity::frequency})
    for (const auto& [suffix, scale] : units_of(quantity))
      if (object_->contains(std::string(name) + suffix)) return true;
  return false;
}

double JsonReader::number(std::string_view key) {
  const json* found = find(key);
  if (!found) fail_missing(key, {});
  if (!found->is_number()) fail(key, "must be a number, is " + shown(*found));
  const double number = found->get<double>();
  if (!std::isfinite(number)) fail(key, "must be finite");
  return number;
}

double JsonReader::number(std::string_view key, double otherwise) {
  return find(key) ? number(key) : otherwise;
}

long JsonReader::integer(std::string_view key) {
  const json* found = find(key);
  if (!found) fail_missing(key, {});
  if (!found->is_number_integer()) fail(key, "must be a whole number, is " + shown(*found));
  if (found->is_number_unsigned() && !std::in_range<long>(found->get<std::uint64_t>()))
    fail(key, "is " + shown(*found) + ", over the range of 64 bits");
  return found->get<long>();
}

long JsonReader::integer(std::string_view key, long otherwise) {
  return find(key) ? integer(key) : otherwise;
}

bool JsonReader::boolean(std::string_view key, bool otherwise) {
  const json* found = find(key);
  if (!found) return otherwise;
  if (!found->is_boolean()) fail(key, "must be true or false, is " + shown(*found));
  return found->get<bool>();
}

std::string JsonReader::text(std::string_view key) {
  const json* found = find(key);
  if (!found) fail_missing(key, {});
  if (!found->is_string()) fail(key, "must be a text, is " + shown(*found));
  return found->get<std::string>();
}

std::string JsonReader::text(std::string_view key, const std::string& otherwise) {
  return find(key) ? text(key) : otherwise;
}

std::vector<double> JsonReader::numbers(std::string_view key) {
  const json* found = find(key);
  if (!found) fail_missing(key, {});
  if (!found->is_array()) fail(key, "must be a list of numbers, is " + shown(*found));
  std::vector<double> list;
  for (const json& entry : *found) {
    if (!entry.is_number() || !std::isfinite(entry.get<double>()))
      fail(key, "must hold finite numbers only, has " + shown(entry));
    list.push_back(entry.get<double>());
  }
  return list;
}

const json* JsonReader::find_quantity(std::string_view name, const Units& units, double& scale,
                                      std::string& key) {
  const json* found = nullptr;
  for (const auto& [suffix, factor] : units) {
    const std::string candidate = std::string(name) + suffix;
    const json* here = find(candidate);
    if (here && found) fail(candidate, "is given in two units");
    if (here) {
      found = here;
      scale = factor;
      key = candidate;
    }
  }
  return found;
}

double JsonReader::quantity(std::string_view name, const Units& units, const double* otherwise) {
  double scale = 1;
  std::string key;
  if (find_quantity(name, units, scale, key)) return scale * number(key);
  if (otherwise) return *otherwise;
  fail_missing(name, units);
}

double JsonReader::length_m(std::string_view name) {
  return quantity(name, units_of(Quantity::length), nullptr);
}
double JsonReader::length_m(std::string_view name, double otherwise_m) {
  return quantity(name, units_of(Quantity::length), &otherwise_m);
}
double JsonReader::angle_rad(std::string_view name) {
  return quantity(name, units_of(Quantity::angle), nullptr);
}
double JsonReader::angle_rad(std::string_view name, double otherwise_rad) {
  return quantity(name, units_of(Quantity::angle), &otherwise_rad);
}
double JsonReader::time_s(std::string_view name) {
  return quantity(name, units_of(Quantity::time), nullptr);
}
double JsonReader::time_s(std::string_view name, double otherwise_s) {
  return quantity(name, units_of(Quantity::time), &otherwise_s);
}
double JsonReader::frequency_hz(std::string_view name) {
  return quantity(name, units_of(Quantity::frequency), nullptr);
}

std::vector<double> JsonReader::lengths_m(std::string_view name) {
  double scale = 1;
  std::string key;
  if (!find_quantity(name, units_of(Quantity::length), scale, key))
    fail_missing(name, units_of(Quantity::length));
  auto list = numbers(key);
  for (double& entry : list) entry *= scale;
  return list;
}

std::vector<double> JsonReader::frequencies_hz(std::string_view name) {
  double scale = 1;
  std::string key;
  if (!find_quantity(name, units_of(Quantity::frequency), scale, key))
    fail_missing(name, units_of(Quantity::frequency));
  auto list = numbers(key);
  for (double& entry : list) entry *= scale;
  return list;
}

Eigen::Vector3d JsonReader::vector_m(std::string_view name) {
  const auto list = lengths_m(name);
  if (list.size() != 3) fail(name, "must have three numbers, has " + std::to_string(list.size()));
  return {list[0], list[1], list[2]};
}

Eigen::Vector3d JsonReader::vector_m(std::string_view name, const Eigen::Vector3d& otherwise_m) {
  double scale = 1;
  std::string key;
  return find_quantity(name, units_of(Quantity::length), scale, key) ? vector_m(name) : otherwise_m;
}

JsonReader JsonReader::object(std::string_view key) {
  const json* found = find(key);
  if (!found) fail_missing(key, {});
  return JsonReader(*found, place_ + "/" + std::string(key));
}

std::vector<JsonReader> JsonReader::objects(std::string_view key) {
  const json* found = find(key);
  if (!found) fail_missing(key, {});
  if (!found->is_array()) fail(key, "must be a list of objects");
  std::vector<JsonReader> list;
  for (std::size_t i = 0; i < found->size(); ++i)
    list.emplace_back((*found)[i], place_ + "/" + std::string(key) + "/" + std::to_string(i));
  return list;
}

const json& JsonReader::value(std::string_view key) {
  const json* found = find(key);
  if (!found) fail_missing(key, {});
  return *found;
}

Pose JsonReader::placement() {
  const Eigen::Vector3d position = vector_m("position", Eigen::Vector3d::Zero());
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  if (find("rotation_deg")) {
    const auto angles = numbers("rotation_deg");
    if (angles.size() != 3) fail("rotation_deg", "must have three angles about x, y, z");
    for (int axis = 0; axis < 3; ++axis)
      rotation = Eigen::AngleAxisd(rad_from_deg(angles[axis]), Eigen::Vector3d::Unit(axis))
                     .toRotationMatrix() *
                 rotation;
  }
  return make_pose(rotation, position);
}

std::vector<std::string> JsonReader::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, value] : object_->items()) names.push_back(key);
  return names;
}

void JsonReader::finish() const {
  for (const auto& [key, value] : object_->items()) {
    if (known_.contains(key)) continue;
    const std::string near =
        nearest_word(key, std::vector<std::string>(known_.begin(), known_.end()));
    throw Error(Trouble::input, place_ + "/" + key + ": unknown key",
                near.empty() ? "" : "did you mean '" + near + "'?");
  }
}

}  // namespace scan
