// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Measurements against limits.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace scan {

struct Interval {
  double low = 0;
  double high = 0;
};

// One figure. `over` says what it was taken over (sample, denominator); `count` how many entered.
// Where it is an estimate from samples drawn on a surface, `interval` holds the figure of the whole
// surface with 95 % confidence. Where it tells whether stated uncertainties are honest, `expected`
// is where it lies, 19 times out of 20, if they are.
struct Measurement {
  std::string name;
  double value = 0;
  std::string unit;  // "m", "rad", "px", "1" or "count"
  std::string over;
  std::size_t count = 0;
  std::optional<double> limit = {};
  std::string relation = {};  // "<=", ">=", "==" or "within" (|value| <= limit) with a limit
  std::string reason = {};    // of the limit
  bool pass = true;           // true without a limit; NaN never passes a limit
  std::optional<Interval> interval = {};
  std::optional<Interval> expected = {};
};

// `value` and `unit` in SI (metres, radians) as Measurement has them.
struct Limit {
  std::string name;
  std::string relation;
  double value = 0;
  std::string reason;
};

struct Verdict {
  std::vector<Measurement> measurements;
  bool pass = true;
};

// Attaches limits to the measurements of the same name; a measurement with several limits is listed
// once for each. Throws scan::Error (input) for a limit whose name was not measured, with the
// nearest name as a hint, and for a relation that is none of the four, a limit that is
// NaN, and one "within" less than 0.
Verdict judge(std::vector<Measurement> measurements, const std::vector<Limit>& limits);

}  // namespace scan
