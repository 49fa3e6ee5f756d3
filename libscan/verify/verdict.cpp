// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Judging measurements by limits, with a hint for a name that was not measured.
#include "libscan/verify/verdict.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "libscan/core/error.h"
#include "libscan/verify/definitions.h"

namespace scan {
namespace {

// Fewest insertions, deletions and replacements that turn a into b (Levenshtein 1966).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

std::string hint_for(const std::string& name, const std::vector<Measurement>& measurements) {
  if (measurements.empty()) return "nothing was measured";
  if (const std::string known = definition(name); !known.empty())
    return "it is the " + known + ", which this input does not have";
  const auto nearest = std::min_element(
      measurements.begin(), measurements.end(), [&](const Measurement& a, const Measurement& b) {
        return edit_distance(a.name, name) < edit_distance(b.name, name);
      });
  return "did you mean '" + nearest->name + "'?";
}

bool holds(double value, const std::string& relation, double limit) {
  if (relation == "<=") return value <= limit;
  if (relation == ">=") return value >= limit;
  return value == limit;  // false for NaN, as are the others
}

void check(const Limit& limit) {
  const std::string& r = limit.relation;
  if (r != "<=" && r != ">=" && r != "==")
    throw Error(Trouble::input,
                "limit '" + limit.name + "': relation is '" + r + "', must be '<=', '>=' or '=='");
  if (std::isnan(limit.value))
    throw Error(Trouble::input, "limit '" + limit.name + "': value is not a number");
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
