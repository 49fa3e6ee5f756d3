// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/run_files.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_reader.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"
#include "libscan/io/stated_poses_file.h"

namespace scan {

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

nlohmann::ordered_json read_ordered_json(const std::filesystem::path& path) {
  (void)read_json(path);  // which says more of what is broken
  return nlohmann::ordered_json::parse(read_file(path), nullptr, true, true);
}

void read_of_run(const std::function<void()>& read) {
  try {
    read();
  } catch (const Error& error) {
    if (error.trouble() != Trouble::input || !error.hint().empty()) throw;
    throw Error(Trouble::input, error.what(),
                "was the run cut short? scan run --resume goes on with it, --force begins anew");
  }
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

StatedPoses read_run_stated_poses(const std::filesystem::path& run) {
  const auto path = run / "alignment.json";
  return std::filesystem::exists(path) ? read_stated_poses(path) : StatedPoses{};
}

}  // namespace scan
