// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Judging measurements by limits, with a hint for a name that was not measured.
#include "libscan/verify/verdict.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/error.h"
#include "libscan/verify/definitions.h"

namespace scan {
namespace {

std::string hint_for(const std::string& name, const std::vector<Measurement>& measurements) {
  if (measurements.empty()) return "nothing was measured";
  const std::string known = definition(name);
  return known.empty() ? figure_hint(name) : "a figure which this input does not have: " + known;
}

bool holds(double value, const std::string& relation, double limit) {
  if (relation == "<=") return value <= limit;
  if (relation == ">=") return value >= limit;
  if (relation == "within") return std::abs(value) <= limit;
  return value == limit;  // false for NaN, as are the others
}

void check(const Limit& limit) {
  const std::string& r = limit.relation;
  if (r != "<=" && r != ">=" && r != "==" && r != "within")
    throw Error(Trouble::input, "limit '" + limit.name + "': relation is '" + r +
                                    "', must be '<=', '>=', '==' or 'within'");
  if (std::isnan(limit.value))
    throw Error(Trouble::input, "limit '" + limit.name + "': value is not a number");
  if (r == "within" && limit.value < 0)
    throw Error(Trouble::input, "limit '" + limit.name + "': nothing is within less than 0");
}

Measurement judged(Measurement measurement, const Limit& limit) {
  measurement.limit = limit.value;
  measurement.relation = limit.relation;
  measurement.reason = limit.reason;
  measurement.pass = holds(measurement.value, limit.relation, limit.value);
  return measurement;
}

}  // namespace

Verdict judge(std::vector<Measurement> measurements, const std::vector<Limit>& limits) {
  for (const Limit& limit : limits) {
    check(limit);
    const bool measured = std::any_of(measurements.begin(), measurements.end(),
                                      [&](const Measurement& m) { return m.name == limit.name; });
    if (!measured)
      throw Error(Trouble::input, "limit '" + limit.name + "': no such measurement",
                  hint_for(limit.name, measurements));
  }
  Verdict verdict;
  for (const Measurement& measurement : measurements) {
    bool limited = false;
    for (const Limit& limit : limits) {
      if (limit.name != measurement.name) continue;
      verdict.measurements.push_back(judged(measurement, limit));
      verdict.pass = verdict.pass && verdict.measurements.back().pass;
      limited = true;
    }
    if (!limited) verdict.measurements.push_back(measurement);
  }
  return verdict;
}

}  // namespace scan
