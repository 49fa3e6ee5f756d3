// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Reports of the small run, made by the program.
#pragma once

#include <nlohmann/json.hpp>

#include "tests/tools/small_run.h"

namespace scan::test {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct Written {
  Outcome outcome;
  std::string page, csv;
  ordered_json twin;
};

inline Written report_of(const fs::path& run, const Folder& folder,
                         const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"report", run.string(), (folder / "out.html").string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  Written written{run_scan(arguments), slurp(folder / "out.html"), slurp(folder / "out.csv"), {}};
  if (fs::exists(folder / "out.json"))
    written.twin = ordered_json::parse(slurp(folder / "out.json"));
  return written;
}

// The small run, to be broken.
inline fs::path copy_of_run(const Folder& folder) {
  fs::copy(small_run(), folder / "run", fs::copy_options::recursive);
  return folder / "run";
}

inline bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace scan::test
