// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The stages of `scan run`, each from the run folder into the run folder.
#pragma once

#include <filesystem>

#include "libscan/verify/verdict.h"
#include "tools/console.h"
#include "tools/recipe.h"
#include "tools/shard.h"

namespace scan {

struct SimulateOptions {
  bool keep_raw = false;
  Shard shard;  // the scans that this process makes
  // Fingerprint of all that decides a scan: one of the same inputs that is there already is kept.
  // Empty: none is.
  std::string inputs;
};

// Renders each viewpoint's raw frames, decodes them, and writes scans, truth, effects.json and, if
// kept, the raw frames. False while scans of other shards are missing: the last shard to end writes
// what belongs to all.
bool simulate_run(const std::filesystem::path& run, const Recipe& recipe,
                  const SimulateOptions& options, Console& console);

// scans/ -> alignment.json, pose_trace.json, poses.tum. scan::Error (computation) if a scan could
// not be aligned.
void align_run(const std::filesystem::path& run, const Recipe& recipe, Console& console);

// scans/, poses.tum -> surface.ply, reconstruction.json.
void reconstruct_run(const std::filesystem::path& run, const Recipe& recipe, Console& console);

// Everything and truth/ -> verdict.json.
Verdict verify_run(const std::filesystem::path& run, Console& console);

}  // namespace scan
