// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which settings of a study are worth their seconds, and in what order to try them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/study.h"

namespace scan {

// A setting's runs taken together.
struct StudyPoint {
  Setting setting;
  std::size_t runs = 0;
  double error = 0;  // mean over the seeds; NaN if any run failed
  double least_error = 0, most_error = 0;
  std::vector<double> errors;  // seed by seed; NaN for a run that failed
  std::string unit;
  double seconds = 0;                // mean of those that count
  std::vector<double> seed_seconds;  // seed by seed
  StageCosts stages;                 // mean seconds, largest memory
  std::string trouble;               // of the first run that failed
  bool on_front = false;             // no other is both as good and as fast
};

// Marks the points of the Pareto front.
void mark_front(std::vector<StudyPoint>& points);

// The cheapest point whose error is within the tolerance; the most accurate one if none is, or if
// there is no tolerance (0); of those that ran with the most seeds. None if all of them failed.
std::optional<std::size_t> advised(const std::vector<StudyPoint>& points, double tolerance);

// Runs a setting with that many seeds; what ran before is not run again.
using Measure = std::function<StudyPoint(const Setting& setting, int seeds)>;

// Every setting with every seed.
std::vector<StudyPoint> search_grid(const Study& study, const Measure& measure);

// A few runs spread over the grid; then, one run at a time, what is
// most often the advice among drawings of the whole grid from a model of all runs so far
// (StudyModel; Thompson 1933, counted), until that is what has run with all its seeds, or a fifth
// of the grid's runs is done. Returns all that it tried; at least one setting ran with all seeds.
std::vector<StudyPoint> search_adaptively(const Study& study, double tolerance,
                                          const Measure& measure);

}  // namespace scan
