// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A study at work: settings run seed by seed, with the time that is left, and where errors come
// from.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/console.h"
#include "tools/study_runs.h"
#include "tools/study_search.h"

namespace scan {

// A part of the mean square of a setting's error.
struct ErrorSource {
  std::string name;
  double share = 0;  // of the whole; sources that make up for each other sum to more than 1
  double error = 0;  // its root, in the figure's unit
};

class StudyWork {
 public:
  // Reads the recipe's "tradeoff" and the recipe of every setting, so that slips are told before
  // the first run. scan::Error (input) if anything in them is wrong. Runs go to `out`/runs.
  StudyWork(const std::string& recipe, const std::filesystem::path& out, Console& console);

  const Study& study() const { return study_; }
  const std::string& name() const { return name_; }
  std::size_t runs_done() const { return done_; }
  std::size_t runs_of_grid() const { return total_; }  // of all cases

  // The setting's runs with so many seeds.
  StudyPoint measure(const Case& in, const Setting& setting, int seeds);

  // What the setting's error consists of, by sparing the runs one source after another: the poses'
  // errors, miscalibration, effects, noise; the rest is the surface's own. Of a pose's error the
  // rest is registration, of a range's the decoding. Sources that changed no run are left out.
  // Empty if a run fails.
  std::vector<ErrorSource> sources(const Case& in, const Setting& setting);

 private:
  RunOutcome run(const Case& in, const Setting& setting, int seed, const Spared& spared);
  double mean_square(const Case& in, const Setting& setting, const Spared& spared);
  std::string time_left() const;

  Console& console_;
  nlohmann::json recipe_;
  Study study_;
  std::uint64_t seed_ = 1;
  std::string name_;
  StudyRuns runs_;
  std::map<std::string, RunOutcome> outcomes_;  // by the run's name
  std::size_t done_ = 0, total_ = 0;
  Stopwatch watch_;
};

// "reconstruct/depth 7, align/method symmetric"
std::string setting_text(const Study& study, const Setting& setting);

}  // namespace scan
