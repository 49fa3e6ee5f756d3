// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the tests of io share: a folder that vanishes, the outside data, and broken copies of a
// file.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/random.h"
#include "libscan/io/atomic_file.h"

namespace scan {

// A folder of its own for each test, removed with it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ =
        std::filesystem::temp_directory_path() / ("libscan_" + std::to_string(::getpid()) + "_" +
                                                  test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::filesystem::path outside_data() {
  return std::filesystem::path(LIBSCAN_SOURCE_DIR) / ".." / "shared" / "data";
}

// The message of the scan::Error that `body` must throw.
inline std::string error_of(const std::function<void()>& body, Trouble trouble = Trouble::input) {
  try {
    body();
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), trouble) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no scan::Error was thrown";
  return {};
}

// Its hint.
inline std::string hint_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    return error.hint();
  }
  ADD_FAILURE() << "no scan::Error was thrown";
  return {};
}

// Hands `read` every truncation of a good file and `flips` copies with up to four bytes changed.
// Each must be read or refused by scan::Error; anything else (another exception, a crash) fails.
inline void expect_read_or_refused(const std::string& good, int flips,
                                   const std::function<void(const std::string&)>& read) {
  const auto attempt = [&](const std::string& bytes, const std::string& what) {
    try {
      read(bytes);
    } catch (const Error&) {
    } catch (const std::exception& error) {
      ADD_FAILURE() << what << ": not a scan::Error: " << error.what();
    }
  };
  for (std::size_t size = 0; size <= good.size(); ++size)
    attempt(good.substr(0, size), "cut to " + std::to_string(size) + " bytes");
  for (int flip = 0; flip < flips; ++flip) {
    RandomStream random(1, 0, static_cast<std::uint64_t>(flip));
    std::string bytes = good;
    for (std::uint32_t left = 1 + random.bits32() % 4; left > 0; --left)
      bytes[random.bits32() % bytes.size()] = static_cast<char>(random.bits32());
    attempt(bytes, "flip " + std::to_string(flip));
  }
}

}  // namespace scan
