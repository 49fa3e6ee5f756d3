// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The runs of a study: each in a folder of its own, sharing the stages that their settings share.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/console.h"
#include "tools/recipe.h"
#include "tools/study.h"

namespace scan {

// What one run gave. Costs by stage: simulate, acquire, align, reconstruct; a stage that was shared
// counts what it took when it was done. Memory of simulate and acquire is told as simulate's.
struct RunOutcome {
  double error = 0;  // the figure, in its unit; NaN if the run failed
  std::string unit;  // "m", "rad", ...
  StageCosts stages;
  std::string trouble;  // why it failed, empty if it did not
};

// Which errors a run is spared, to tell what the others come from. The random streams of the other
// sources stay as they are.
struct Spared {
  bool poses = false;        // the true poses stand in for the aligned ones
  bool calibration = false;  // the device is as its calibration says
  bool effects = false;      // of light and device but noise and miscalibration
  bool noise = false;        // of the detector, and speckle
};

class StudyRuns {
 public:
  // `place` and `folder` are the recipe's file and where its meshes lie. Runs go to `out`/runs.
  StudyRuns(std::string place, std::filesystem::path folder, std::filesystem::path out);

  // Runs `recipe`, as it stands in its file but for what is varied, under this seed; or reads its
  // outcome if the folder `name` holds the same run already. scan::Error (input) for a recipe that
  // cannot be read or a figure that no run measures; what fails later is the outcome's trouble.
  RunOutcome run(const std::string& name, const StudyRecipe& recipe, std::uint64_t seed,
                 const std::string& figure, const Spared& spared = {});

  // The recipe as a run of it begins. scan::Error (input) as above.
  Recipe read(const StudyRecipe& recipe) const;

 private:
  void do_stages(const std::filesystem::path& run, const Recipe& recipe, const Spared& spared,
                 Console& console, StageCosts& costs);

  std::string place_;
  std::filesystem::path folder_, runs_;
  struct Done {
    std::filesystem::path run;
    StageCosts costs;
  };
  std::map<std::string, Done> done_;  // by the fingerprint of all that decides a stage
};

}  // namespace scan
