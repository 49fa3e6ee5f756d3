// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A run folder at work: opened safely, its stages done once, continued after an interruption.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "libscan/io/run_folder.h"
#include "tools/command_line.h"
#include "tools/recipe.h"

namespace scan {

struct RunSettings {
  bool keep_raw = false;
  bool resume = false;
  bool force = false;
  std::string shard;    // "2/4", or empty: the whole run
  std::string effects;  // overrides the recipe's choice unless empty
  long seed = -1;       // overrides the recipe's seed unless negative
};
void declare_run_settings(CommandLine& line, RunSettings& settings);

class RunSession {
 public:
  // Reads the recipe, applies the settings, and opens the folder `run`:
  // one that holds an earlier run is refused, unless --force clears that run's files or --resume
  // continues it (then the recipe must be the same).
  // Writes recipe.json with all defaults filled in.
  RunSession(const std::filesystem::path& recipe, const std::filesystem::path& run,
             const RunSettings& settings, Console& console);

  // Runs a stage unless it is recorded as done and its outputs are there unchanged. A stage behind
  // one that ran is always run again.
  using Work = std::function<void(const std::filesystem::path& run, const Recipe& recipe)>;
  void stage(const std::string& name, const Work& work);

  // The first stage, or the share of it that the settings name; false while other shares are
  // missing.
  bool simulate();

  // Writes report.html and its twins unless it is there and no stage ran. It is no recorded stage:
  // it shows seconds, and stages.json is the same for equal runs.
  void report();

  const Recipe& recipe() const { return recipe_; }

  // Prints the results that the folder holds; the exit code is 1 if there is a verdict that fails.
  int finish(const std::string& command);
  // And `more` of them; the exit code is 1 unless `pass`, too.
  int finish(const std::string& command, const nlohmann::ordered_json& more, bool pass);

 private:
  // True once the stage is whole; only then it is recorded.
  bool part_of_stage(const std::string& name, const std::function<bool()>& work);

  std::filesystem::path run_;
  Recipe recipe_;
  Console& console_;
  bool a_stage_ran_ = false;
  RunFolder folder_;
  RunSettings settings_;
  std::string inputs_;  // fingerprint of what decides every stage's output
};

}  // namespace scan
