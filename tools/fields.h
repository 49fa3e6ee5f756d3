// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// One list of keys per struct, used to read a recipe and to write it back with all defaults filled
// in.
//
// A struct takes part by a function `void fields(Fields&, Struct&)` that names its keys. Quantities
// are read in any unit (radius_mm, radius_m) and written in SI (radius_m), with digits that read
// back to the same bits.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "libscan/core/pose.h"

namespace scan {

enum class Need { required, optional };

class Fields {
 public:
  virtual ~Fields() = default;
  virtual void number(std::string_view key, double& value, Need need = Need::optional) = 0;
  virtual void integer(std::string_view key, int& value, Need need = Need::optional) = 0;
  virtual void boolean(std::string_view key, bool& value) = 0;
  virtual void text(std::string_view key, std::string& value, Need need = Need::optional) = 0;
  // One of `names`; `selected` is its index.
  virtual void choice(std::string_view key, int& selected,
                      const std::vector<std::string>& names) = 0;
  virtual void length(std::string_view name, double& value_m, Need need = Need::optional) = 0;
  virtual void angle(std::string_view name, double& value_rad, Need need = Need::optional) = 0;
  virtual void time(std::string_view name, double& value_s, Need need = Need::optional) = 0;
  virtual void frequencies(std::string_view name, std::vector<double>& values_hz) = 0;
  virtual void numbers(std::string_view key, std::vector<double>& values) = 0;
  virtual void vector(std::string_view name, Eigen::Vector3d& value_m) = 0;
  virtual void direction(std::string_view key, Eigen::Vector3d& value) = 0;
  virtual void poses(std::string_view key, std::vector<Pose>& poses) = 0;  // 4x4 matrices
  // A nested object; left as it is when the key is missing and not required.
  virtual void object(std::string_view key, const std::function<void(Fields&)>& inner,
                      Need need = Need::optional) = 0;
  // Exactly one of the keys `names` holds an object; `inner(index, fields)` describes it.
  virtual void one_of(const std::vector<std::string>& names, int& selected,
                      const std::function<void(int, Fields&)>& inner) = 0;
  // Broken values that only the whole struct reveals are reported at this place.
  virtual std::string place() const = 0;
};

}  // namespace scan
