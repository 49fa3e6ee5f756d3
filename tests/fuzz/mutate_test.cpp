// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/mutate.h"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/fuzz/allocation.h"
#include "tests/fuzz/fuzz.h"

namespace scan::test {
namespace {

TEST(Mutate, SameNumberSameBytesOtherNumberOtherBytes) {
  const std::string good = "ply\nelement vertex 3\n0 0 0\n1 0 0\n0 1 0\n";
  std::set<std::string> copies;
  for (std::uint64_t number = 0; number < 300; ++number) {
    copies.insert(mutated(good, number));
    EXPECT_EQ(mutated(good, number), mutated(good, number));
  }
  EXPECT_GT(copies.size(), 280u);
  EXPECT_TRUE(std::any_of(copies.begin(), copies.end(), [](const std::string& copy) {
    return copy.find("element vertex 18446744073709551615") != std::string::npos;
  }));
}

// The harness itself: each kind of fault is seen.
TEST(Fuzz, SeesAForeignExceptionANamelessErrorAndTooMuchMemory) {
  const TemporaryFolder folder;
  const auto path = folder / "a.txt";
  const std::string good = "1 2 3 4 5 6 7 8 9";
  const auto faults_of = [&](const Reader& otherwise) {
    write_file(path, good);
    testing::TestPartResultArray faults;
    {
      const testing::ScopedFakeTestPartResultReporter reporter(
          testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &faults);
      fuzz(path, [&](const auto& file) {
        if (read_file(file) != good) otherwise(file);
      });
    }
    return faults.size();
  };
  EXPECT_EQ(faults_of([](const auto&) {}), 0);
  EXPECT_EQ(faults_of([](const auto& file) { throw Error(Trouble::input, file.string()); }), 0);
  EXPECT_EQ(faults_of([](const auto&) { throw Error(Trouble::input, "broken"); }), 5);
  EXPECT_EQ(faults_of([](const auto&) { throw std::out_of_range("vector"); }), 5);
  watch_allocations();
  { const std::vector<double> many(1 << 10); }
  if (peak_allocated_bytes() == 0) GTEST_SKIP() << "the sanitizer's allocator is not watched";
  EXPECT_EQ(faults_of([](const auto&) { const std::vector<double> many(1 << 20); }), 5);
}

}  // namespace
}  // namespace scan::test
