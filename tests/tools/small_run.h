// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A run that takes a second or two and has every part of a report.
#pragma once

#include "tests/tools/program.h"

namespace scan::test {

// Runs tests/tools/small_run.json once for a program; the folder goes with it.
inline const std::filesystem::path& small_run() {
  static const Folder folder;
  static const std::filesystem::path run = [] {
    const Outcome outcome = run_scan(
        {"run", LIBSCAN_SOURCE_DIR "/tests/tools/small_run.json", (folder / "run").string()});
    if (outcome.exit_code != 0 && outcome.exit_code != 1)
      throw std::runtime_error("small run: " + outcome.err);
    return folder / "run";
  }();
  return run;
}

}  // namespace scan::test
