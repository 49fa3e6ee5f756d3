// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a run folder holds, read for its report.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "libscan/core/mesh.h"
#include "libscan/core/scan.h"
#include "libscan/verify/pose_error.h"
#include "tools/pose_trace.h"

namespace scan {

// JSON parts have the keys of the run folder's files and are null where there is no such file.
struct RunRecord {
  std::string title;
  nlohmann::ordered_json recipe, effects, alignment, reconstruction, verdict, timings;
  nlohmann::ordered_json artefacts;  // as `scan verify --artefacts --json` prints it
  nlohmann::ordered_json tradeoff;   // tradeoff.json
  // All in one world: the true one where there is a truth, else the aligned scans'.
  std::vector<Scan> scans;  // clouds in their scanner frames
  std::vector<Pose> world_from_scan;
  std::vector<PoseStep> steps;  // of the alignment
  Mesh surface;
  std::vector<PoseError> pose_errors;  // per scan; empty: no truth
  std::vector<double> deviations_m;    // per vertex of the surface; empty: no truth
  std::vector<double> support_m;       // per vertex: distance to the nearest point; empty: unknown
  std::vector<std::string> missing;  // what is not there and what it keeps the report from showing
};

// Throws scan::Error (input) for a folder without recipe.json, for broken files and for parts that
// do not belong together. `artefacts` and `tradeoff` name files; empty: artefacts.json and
// tradeoff.json of the folder, if they are there.
RunRecord read_record(const std::filesystem::path& run, const std::filesystem::path& artefacts = {},
                      const std::filesystem::path& tradeoff = {});

}  // namespace scan
