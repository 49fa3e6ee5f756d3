// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The report: one self-contained HTML page that opens from disk without network.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/report/picture.h"

namespace scan {

// Everything the page shows; JSON parts have the keys of the run folder's files and may be null.
struct Report {
  std::string title;
  nlohmann::ordered_json recipe;
  nlohmann::ordered_json effects;
  nlohmann::ordered_json simulation;  // per scan: rays, points, misses
  nlohmann::ordered_json alignment;
  nlohmann::ordered_json reconstruction;
  nlohmann::ordered_json verdict;
  nlohmann::ordered_json seconds;  // the only part that differs between equal runs
  Mesh surface;
  std::vector<double> deviations_m;  // one per vertex of the surface
};

// Timings stand in one element, <table id="seconds">, on a line of its own.
std::string report_page(const Report& report);

}  // namespace scan
