// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Fields read from JSON.
#pragma once

#include "libscan/io/json_reader.h"
#include "tools/fields.h"

namespace scan {

class FieldReader : public Fields {
 public:
  // `reader` must outlive this; unknown keys are not judged here (JsonReader::finish does).
  explicit FieldReader(JsonReader& reader) : reader_(reader) {}
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
  std::string place() const override { return reader_.place(); }

 private:
  JsonReader& reader_;
};

}  // namespace scan
