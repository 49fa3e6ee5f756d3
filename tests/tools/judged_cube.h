// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Cubes held against the unit cube by `scan verify`.
#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/tools/program.h"

namespace scan::test {

// A cube of the given edge with a corner at (x, 0, 0); `extra` are further lines of faces.
inline std::string cube_off(double edge, double x, const std::string& extra = "",
                            int extra_faces = 0) {
  std::string text = "OFF\n8 " + std::to_string(12 + extra_faces) + " 0\n";
  for (int corner = 0; corner < 8; ++corner) {
    char line[96];
    std::snprintf(line, sizeof line, "%.17g %.17g %.17g\n", x + edge * (corner & 1),
                  edge * (corner >> 1 & 1), edge * (corner >> 2 & 1));
    text += line;
  }
  for (const char* face : {"0 2 3", "0 3 1", "4 5 7", "4 7 6", "0 1 5", "0 5 4", "2 6 7", "2 7 3",
                           "0 4 6", "0 6 2", "1 3 7", "1 7 5"})
    text += std::string("3 ") + face + "\n";
  return text + extra;
}

struct Judged {
  Outcome outcome;
  nlohmann::json json;
  double figure(const std::string& name) const {
    for (const auto& m : json.at("measurements"))
      if (m.at("name") == name) return m.at("value").get<double>();
    throw std::runtime_error(name + " was not measured");
  }
};

inline Judged judged(const Folder& folder, const std::string& measured,
                     const std::vector<std::string>& more = {}) {
  spill(folder / "measured.off", measured);
  spill(folder / "truth.off", cube_off(1, 0));
  std::vector<std::string> arguments{
      "verify", (folder / "measured.off").string(), "--truth", (folder / "truth.off").string(),
      "--json",
  };
  arguments.insert(arguments.end(), more.begin(), more.end());
  Judged result{run_scan(arguments), {}};
  if (!result.outcome.out.empty()) result.json = nlohmann::json::parse(result.outcome.out);
  return result;
}

inline bool says(const Outcome& outcome, const std::string& words) {
  return outcome.err.find(words) != std::string::npos;
}

}  // namespace scan::test
