// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/stated_poses_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/json_reader.h"

namespace scan {
namespace {

using nlohmann::json;

Matrix6 matrix_from(const json& rows) {
  Matrix6 matrix;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column)
      matrix(row, column) = rows.at(row).at(column).get<double>();
  return matrix;
}

std::optional<StatedPose> stated_pose(const json& scan) {
  if (scan.at("covariance").is_null()) return std::nullopt;
  StatedPose stated{.covariance = matrix_from(scan.at("covariance"))};
  for (int k = 0; k < 3; ++k) stated.centre(k) = scan.at("covariance_centre_m").at(k).get<double>();
  return stated;
}

CommonCovariance common_covariance(const json& couple, std::size_t scans,
                                   const std::filesystem::path& path) {
  const auto number = [&](int k) {
    const auto index = couple.at("scans").at(k).get<std::int64_t>();
    if (index < 0 || index >= static_cast<std::int64_t>(scans))
      throw Error(Trouble::input, path.string() + ": covariances_between: names scan " +
                                      std::to_string(index) + " of " + std::to_string(scans));
    return static_cast<std::size_t>(index);
  };
  const CommonCovariance common{number(0), number(1), matrix_from(couple.at("covariance"))};
  if (common.first >= common.second)
    throw Error(Trouble::input, path.string() + ": covariances_between: scan " +
                                    std::to_string(common.first) + " before scan " +
                                    std::to_string(common.second) + ", must ascend");
  return common;
}

}  // namespace

StatedPoses read_stated_poses(const std::filesystem::path& path) {
  const json alignment = read_json(path);
  StatedPoses stated;
  try {
    for (const auto& scan : alignment.at("scans")) stated.scans.push_back(stated_pose(scan));
    if (!alignment.contains("covariances_between")) return stated;  // of an earlier version
    for (const auto& couple : alignment.at("covariances_between"))
      stated.between.push_back(common_covariance(couple, stated.scans.size(), path));
    std::sort(stated.between.begin(), stated.between.end(),
              [](const CommonCovariance& a, const CommonCovariance& b) {
                return std::pair(a.first, a.second) < std::pair(b.first, b.second);
              });
  } catch (const json::exception& error) {
    throw Error(Trouble::input, path.string() + ": is not an alignment (" + error.what() + ")");
  }
  return stated;
}

}  // namespace scan
