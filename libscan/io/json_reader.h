// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Strict reading of JSON: unknown keys, wrong types, wrong units and impossible values are errors
// that name file, place, value and limit, with the nearest known key as a hint.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "libscan/core/pose.h"
#include "libscan/io/json_units.h"

namespace scan {

// A view on one JSON object. Each getter marks its key as known; `finish()` refuses what is left.
// Lengths carry their unit in the key: length_m("radius") reads radius_m, _mm, _um or _nm
// and returns metres; angle_rad reads _deg or _rad; time_s reads _s, _ms, _us or _ns; frequency_hz
// reads _hz or _mhz. Without a default the key is required.
class JsonReader {
 public:
  // `place` is how messages name this object: a file name, then a JSON pointer.
  JsonReader(const nlohmann::json& object, std::string place);

  bool has(std::string_view key);                  // exactly this key, known from now on
  bool has_quantity(std::string_view name) const;  // this name with any unit

  // The one of these keys that is there; scan::Error (input) if none or two of them are.
  std::string one_of(const std::vector<std::string>& words);

  double number(std::string_view key);
  double number(std::string_view key, double otherwise);
  long integer(std::string_view key);
  long integer(std::string_view key, long otherwise);
  bool boolean(std::string_view key, bool otherwise);
  std::string text(std::string_view key);
  std::string text(std::string_view key, const std::string& otherwise);
  std::vector<double> numbers(std::string_view key);

  double length_m(std::string_view name);
  double length_m(std::string_view name, double otherwise_m);
  std::vector<double> lengths_m(std::string_view name);
  Eigen::Vector3d vector_m(std::string_view name);
  Eigen::Vector3d vector_m(std::string_view name, const Eigen::Vector3d& otherwise_m);
  double angle_rad(std::string_view name);
  double angle_rad(std::string_view name, double otherwise_rad);
  double time_s(std::string_view name);
  double time_s(std::string_view name, double otherwise_s);
  double frequency_hz(std::string_view name);
  std::vector<double> frequencies_hz(std::string_view name);

  JsonReader object(std::string_view key);
  std::vector<JsonReader> objects(std::string_view key);  // an array of objects
  const nlohmann::json& value(std::string_view key);      // as it is

  // Rotation (rotation_deg: three angles about x, y, z, applied in that order) and position.
  Pose placement();

  const std::string& place() const { return place_; }
  std::vector<std::string> keys() const;

  // Throws scan::Error (input) for the first key that no getter asked for.
  void finish() const;

  // scan::Error (input) about a key of this object: "<place>/<key>: <what>".
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;

 private:
  [[noreturn]] void fail_missing(std::string_view name, const JsonUnits& units) const;
  const nlohmann::json* find(std::string_view key);
  const nlohmann::json* find_quantity(std::string_view name, const JsonUnits& units, double& scale,
                                      std::string& key);
  double quantity(std::string_view name, const JsonUnits& units, const double* otherwise);

  const nlohmann::json* object_;
  std::string place_;
  std::set<std::string, std::less<>> known_;
};

// Parses a file; comments are allowed, rubbish behind the value is not, nor numbers beyond double
// or more than 256 levels. scan::Error (input) with the line otherwise.
nlohmann::json read_json(const std::filesystem::path& path);
nlohmann::json parse_json(std::string_view text, const std::string& name);

}  // namespace scan
