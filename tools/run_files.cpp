// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/run_files.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/json_reader.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"

namespace scan {
namespace {

StatedPose stated_pose(const nlohmann::json& scan) {
  StatedPose stated;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column)
      stated.covariance(row, column) = scan.at("covariance").at(row).at(column).get<double>();
  for (int k = 0; k < 3; ++k) stated.centre(k) = scan.at("covariance_centre_m").at(k).get<double>();
  return stated;
}

}  // namespace

std::string scan_name(std::size_t index) {
  char text[24];
  std::snprintf(text, sizeof text, "%03zu", index);
  return text;
}

std::filesystem::path recipe_path(const std::filesystem::path& run) {
  return run / "recipe.json";
}

std::filesystem::path scan_path(const std::filesystem::path& run, std::size_t index) {
  return run / "scans" / (scan_name(index) + ".ply");
}

std::filesystem::path raw_path(const std::filesystem::path& run, std::size_t index) {
  return run / "raw" / scan_name(index);
}

std::filesystem::path truth_path(const std::filesystem::path& run) {
  return run / "truth";
}

std::vector<Scan> read_run_scans(const std::filesystem::path& run) {
  std::vector<Scan> scans;
  while (std::filesystem::exists(scan_path(run, scans.size())))
    scans.push_back(read_scan(scan_path(run, scans.size())));
  if (scans.empty())
    throw Error(Trouble::input, run.string() + ": holds no scans/000.ply; is it a run folder?");
  return scans;
}

std::vector<Pose> read_run_poses(const std::filesystem::path& run) {
  std::vector<Pose> poses;
  for (const NamedPose& pose : read_poses(run / "poses.tum")) poses.push_back(pose.pose);
  return poses;
}

std::vector<std::optional<StatedPose>> read_run_stated_poses(const std::filesystem::path& run) {
  const auto path = run / "alignment.json";
  if (!std::filesystem::exists(path)) return {};
  std::vector<std::optional<StatedPose>> stated;
  const nlohmann::json alignment = read_json(path);
  try {
    for (const auto& scan : alignment.at("scans"))
      stated.push_back(scan.at("covariance").is_null() ? std::nullopt
                                                       : std::optional(stated_pose(scan)));
  } catch (const nlohmann::json::exception& error) {
    throw Error(Trouble::input, path.string() + ": is not an alignment (" + error.what() + ")");
  }
  return stated;
}

}  // namespace scan
