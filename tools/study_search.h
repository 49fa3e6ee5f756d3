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
// there is no tolerance (0). None if every run failed.
std::optional<std::size_t> advised(const std::vector<StudyPoint>& points, double tolerance);

// Runs a setting with that many seeds; what ran before is not run again.
using Measure = std::function<StudyPoint(const Setting& setting, int seeds)>;

// Every setting with every seed.
std::vector<StudyPoint> search_grid(const Study& study, const Measure& measure);

// The setting in the middle of all lists and those that differ from it in one field, with one seed;
// then what is advised among the settings tried and the others as a model sees them, until that one
// has run with all its seeds. In the model each field's value multiplies error and seconds by a
// factor of its own, fitted to what was tried. Finds what the grid finds where that holds nearly.
// Where it does not, what was tried corrects it: up to a fifth of the grid's runs, settings beside
// the advised one are tried, too. Returns all that it tried.
std::vector<StudyPoint> search_adaptively(const Study& study, double tolerance,
                                          const Measure& measure);

}  // namespace scan
