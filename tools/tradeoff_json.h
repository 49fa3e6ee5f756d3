// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A study's results for machines: tradeoff.json and a table of its settings.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "tools/study_work.h"

namespace scan {

// One case's answer. `chosen` is none if every run failed.
struct CaseResult {
  std::string name;
  std::vector<StudyPoint> points;
  std::optional<std::size_t> chosen;
  std::vector<ErrorSource> sources;
  std::size_t runs = 0;  // that the search took
};

struct StudyResult {
  Study study;
  std::vector<CaseResult> cases;
  double tolerance = 0;  // 0: none
  std::string search;
  std::size_t runs_of_grid = 0;  // of one case
};

// Whether every case has settings within the tolerance; true without one.
bool meets_tolerance(const StudyResult& result);

// What to choose and what limits it, in one sentence or two.
std::string advice_text(const StudyResult& result, const CaseResult& in);

// Keys: figure, unit, tolerance, search, machine, threads, seconds (which); runs [{case, settings,
// error_m (in `unit`), least_error, most_error, count, seconds, stages, on_front, trouble}]; cases
// [{name, advice, sources}]; advice {text, meets}.
nlohmann::ordered_json tradeoff_json(const StudyResult& result);

// One row a setting, with a head; of `tradeoff_json`'s runs.
std::string tradeoff_csv(const nlohmann::ordered_json& tradeoff);

}  // namespace scan
