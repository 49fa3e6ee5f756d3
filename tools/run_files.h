// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where things lie in a run folder, and how they are read back.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "libscan/core/scan.h"
#include "libscan/core/stated_poses.h"

namespace scan {

// "000", "001", ...: a scan's name by its index.
std::string scan_name(std::size_t index);

std::filesystem::path recipe_path(const std::filesystem::path& run);
std::filesystem::path scan_path(const std::filesystem::path& run, std::size_t index);
std::filesystem::path raw_path(const std::filesystem::path& run, std::size_t index);
std::filesystem::path truth_path(const std::filesystem::path& run);

// As it stands in the file, keys in their order. scan::Error (input) names the place of what is
// broken.
nlohmann::ordered_json read_ordered_json(const std::filesystem::path& path);

// Calls `read`; to a scan::Error (input) of it without a hint it adds that --resume goes on where a
// run was cut short.
void read_of_run(const std::function<void()>& read);

// All scans in scans/, in their order. scan::Error (input) if there are none.
std::vector<Scan> read_run_scans(const std::filesystem::path& run);

// The poses in poses.tum, one per scan.
std::vector<Pose> read_run_poses(const std::filesystem::path& run);

// The covariances in alignment.json; empty if the file is not there: the
// poses were not estimated. scan::Error (input) if it is broken.
StatedPoses read_run_stated_poses(const std::filesystem::path& run);

}  // namespace scan
