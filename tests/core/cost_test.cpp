// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Peak memory: what was used counts, and what was used before a restart does not.
#include "libscan/core/cost.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

namespace scan {
namespace {

constexpr std::size_t mib = std::size_t{1} << 20;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool keeps_what_is_freed = true;
#elif defined(__has_feature)
constexpr bool keeps_what_is_freed = __has_feature(address_sanitizer);
#else
constexpr bool keeps_what_is_freed = false;
#endif

// The peak while so many MiB are in use: touched, so that they are resident.
double peak_with(std::size_t count_mib) {
  const std::vector<char> block(count_mib * mib, 1);
  return peak_memory_mib();
}

TEST(PeakMemory, HoldsWhatWasUsedAndForgetsItAtARestart) {
  if (!std::filesystem::exists("/proc/self/clear_refs"))
    GTEST_SKIP() << "this system cannot begin a peak anew";
  if (keeps_what_is_freed) GTEST_SKIP() << "the sanitizer holds freed memory back";
  restart_peak_memory();
  const double before_mib = peak_memory_mib();
  EXPECT_GE(peak_with(200), before_mib + 199);
  EXPECT_GE(peak_memory_mib(), before_mib + 199);  // also after it was freed
  restart_peak_memory();
  EXPECT_LT(peak_memory_mib(), before_mib + 20);
  EXPECT_GE(peak_with(50), before_mib + 49);
  EXPECT_LT(peak_memory_mib(), before_mib + 70);
}

}  // namespace
}  // namespace scan
