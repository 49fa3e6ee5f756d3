// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the tests on real data share: where the data lies, and the program's answers as JSON.
#pragma once

#include <gtest/gtest.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace scan::test {

namespace fs = std::filesystem;

inline fs::path data_folder(const std::string& name) {
  return fs::path(LIBSCAN_SOURCE_DIR) / ".." / "shared" / "data" / name;
}

// Skips the running test when the data is not there.
#define SKIP_WITHOUT(folder) \
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the data is not in " << folder

struct Answer {
  int exit_code = -1;
  nlohmann::json json;  // null if the program printed none
  std::string err;
};

// Calls `scan` on two threads and reads what it prints.
inline Answer ask_scan(std::vector<std::string> arguments) {
  for (const char* flag : {"--json", "-q", "--threads", "2"}) arguments.push_back(flag);
  const Outcome outcome = run_scan(arguments);
  return {outcome.exit_code, nlohmann::json::parse(outcome.out, nullptr, false), outcome.err};
}

// The value of one measurement of `scan verify`, printed; NaN and a failure if there is none.
inline double measured(const Answer& verdict, const std::string& name) {
  if (verdict.json.contains("measurements"))
    for (const auto& measurement : verdict.json.at("measurements"))
      if (measurement.at("name") == name) {
        const double value = measurement.at("value").get<double>();
        std::cout << "  " << name << " " << value << " "
                  << measurement.at("unit").get<std::string>() << "\n";
        return value;
      }
  ADD_FAILURE() << "no measurement " << name << "; " << verdict.err;
  return std::numeric_limits<double>::quiet_NaN();
}

inline void print_seconds(const Answer& answer) {
  std::cout << "  seconds of " << answer.json.at("command").get<std::string>() << ": "
            << answer.json.at("seconds").at("total").get<double>() << "\n";
}

}  // namespace scan::test
