// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pictures of the study of convergence basins, as SVG text.
#pragma once

#include <string>
#include <vector>

#include "tests/benchmarks/basins_table.h"

namespace scan::test {

// One panel per overlap: share of starts solved, all shapes together, against the turn or the shift
// of the start; bars: 95 % confidence.
std::string success_figure(const std::vector<Trial>& trials, double Trial::*offset,
                           const std::string& axis);

// One panel per overlap: share of starts solved within a processor time, of those off by at most
// 30 degrees or 20 % of the size.
std::string time_figure(const std::vector<Trial>& trials);

}  // namespace scan::test
