// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Error against seconds, both logarithmic, as SVG text.
#pragma once

#include <string>
#include <vector>

namespace scan {

struct TradeoffMark {
  double seconds = 0;
  double error = 0, least_error = 0, most_error = 0;
  std::string curve;  // marks of one curve share a colour
  std::string label;  // shown when pointed at
  bool on_front = false;
  bool advised = false;
};

// The front is drawn as a line, the tolerance (0: none) as a dashed one. `unit` as in Measurement.
// Marks that are not finite and positive are left out.
std::string tradeoff_plot(const std::vector<TradeoffMark>& marks, const std::string& figure,
                          const std::string& unit, double tolerance);

}  // namespace scan
