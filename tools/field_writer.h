// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Fields written as JSON, in SI units, every default spelled out.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tools/fields.h"

namespace scan {

class FieldWriter : public Fields {
 public:
  // Adds keys to `object`, which must outlive this.
  explicit FieldWriter(nlohmann::ordered_json& object) : object_(object) {}
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
  std::string place() const override { return "written recipe"; }

 private:
  nlohmann::ordered_json& object_;
};

}  // namespace scan
