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
  std::string panel;  // marks of one panel stand in a plot of their own; all have the same axes
  std::string curve;  // marks of one curve share a colour and a line
  std::string label;  // shown when pointed at
  bool on_front = false;
  bool advised = false;
};

struct TradeoffLabels {
  std::string figure, unit;  // of the error; `unit` as in Measurement
  std::string seconds;       // what the seconds are of
};

// Filled marks are the front, a ring is the advice, bars reach from the least to the most error,
// the tolerance (0: none) is a dashed line. Marks that are not finite and positive are left out.
std::string tradeoff_plot(const std::vector<TradeoffMark>& marks, const TradeoffLabels& labels,
                          double tolerance);

}  // namespace scan
