// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The folder of one run, and which of its stages are done.
//
//   recipe.json effects.json scans/000.ply ... raw/000/... truth/ simulation/000.json ...
//   simulation.json alignment.json poses.tum pose_trace.json aligned.ply surface.ply
//   reconstruction.json verdict.json report.html report.json report.csv stages.json
//   timings.json timings/000.json ...
//
// stages.json records each finished stage: the fingerprint of what it was made from and one for
// each file that it wrote. Seconds stand in timings alone: no other file depends on the number of
// threads or of processes.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace scan {

struct StageRecord {
  std::string stage;
  std::string inputs;                          // fingerprint of all that decides the output
  std::map<std::string, std::string> outputs;  // file, relative to the folder -> fingerprint
};

struct RunFolder {
  std::filesystem::path path;
  std::vector<StageRecord> stages;  // in the order in which they were done
};

enum class RunStart {
  fresh,   // the folder must not hold an earlier run
  force,   // an earlier run's files (the names above, nothing else) are removed
  resume,  // an earlier run goes on; without one like fresh
};

// Creates or opens the folder. Throws scan::Error: output if it cannot be created or written, if
// the path is a file, or if it holds an earlier run and `start` is fresh (hint: --force or
// --resume); input if its stages.json is broken.
RunFolder open_run_folder(const std::filesystem::path& path, RunStart start);

// True if the stage was recorded with the same inputs and each of its files is there unchanged.
bool is_done(const RunFolder& folder, std::string_view stage, std::string_view inputs);

// Records a finished stage with the present content of its files (relative paths), in place of an
// earlier record of it and of all stages recorded behind that one, and writes stages.json.
void record_stage(RunFolder& folder, std::string_view stage, std::string_view inputs,
                  const std::vector<std::string>& outputs);

}  // namespace scan
