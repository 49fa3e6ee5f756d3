// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Trials of the study of convergence basins on disk, and what they come to.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace scan::test {

struct Trial {
  std::string shape, method;
  double overlap = 0;           // share of each cloud
  double turn_deg = 0;          // of the start; one of both is zero
  double shift_percent = 0;     // of the size
  double error_percent = 0;     // root mean square of the points' distances, of the size
  double seconds = 0;           // of processor time, normals and trees counted
  bool claims_success = false;  // or says nothing of it
};

// Its error is at most 1 % of the size.
bool is_solved(const Trial& trial);

std::vector<Trial> read_trials(const std::filesystem::path& folder);  // of all CSV files in it
void write_trials(const std::filesystem::path& file, const std::vector<Trial>& trials);

struct Share {
  std::size_t trials = 0, hits = 0;
  double value() const { return trials ? double(hits) / double(trials) : 0; }
  // 95 % confidence (Wilson 1927).
  double low() const;
  double high() const;
};

Share share_of(const std::vector<Trial>& trials, const std::function<bool(const Trial&)>& among,
               const std::function<bool(const Trial&)>& hit);

// The values of a member that occur, ascending.
template <class Value>
std::vector<Value> values_of(const std::vector<Trial>& trials, Value Trial::*member) {
  std::set<Value> values;
  for (const Trial& trial : trials) values.insert(trial.*member);
  return {values.begin(), values.end()};
}

// success.csv: one row per shape, method, overlap and start.
void write_tables(const std::filesystem::path& folder, const std::vector<Trial>& trials);

}  // namespace scan::test
