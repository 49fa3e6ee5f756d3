// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A run that takes a second or two and has every part of a report.
#pragma once

#include <fcntl.h>
#include <sys/file.h>

#include <stdexcept>

#include "tests/tools/program.h"

namespace scan::test {

// Held until the end of the scope; others wait, also in other processes.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& path)
      : file_(open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600)) {
    if (file_ < 0 || flock(file_, LOCK_EX) != 0)
      throw std::runtime_error("cannot lock " + path.string());
  }
  ~FileLock() { close(file_); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int file_;
};

// The folder of tests/tools/small_run.json's run, to be read only. ctest runs each test in a
// process of its own: the first to ask makes the run for all, and it stays until the program or the
// recipe changes.
inline const std::filesystem::path& small_run() {
  namespace fs = std::filesystem;
  static const fs::path made = [] {
    const fs::path recipe = LIBSCAN_SOURCE_DIR "/tests/tools/small_run.json";
    const fs::path kept = LIBSCAN_BINARY_DIR "/small_run", run = kept / "run";
    const auto built = fs::last_write_time(LIBSCAN_BINARY_DIR "/scan").time_since_epoch().count();
    const std::string made_of = std::to_string(built) + "\n" + slurp(recipe);
    fs::create_directories(kept);
    const FileLock lock(kept / "lock");
    if (slurp(kept / "made_of") == made_of) return run;
    fs::remove(kept / "made_of");
    fs::remove_all(run);
    const Outcome outcome = run_scan({"run", recipe.string(), run.string()});
    if (outcome.exit_code != 0 && outcome.exit_code != 1)
      throw std::runtime_error("small run: " + outcome.err);
    spill(kept / "made_of", made_of);
    return run;
  }();
  return made;
}

}  // namespace scan::test
