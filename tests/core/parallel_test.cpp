// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Truths of parallel work: each item once, the same bits for any number of threads.
#include "libscan/core/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "libscan/core/error.h"

namespace scan {
namespace {

constexpr int thread_counts[] = {1, 2, 7};

TEST(ParallelFor, VisitsEachItemOnce) {
  for (const int threads : thread_counts)
    for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 10'000u}) {
      const ThreadLimit limit(threads);
      std::vector<std::atomic<int>> visits(count);
      parallel_for(count, [&](std::size_t i) { ++visits[i]; });
      for (const auto& visit : visits) EXPECT_EQ(visit, 1);
    }
}

TEST(ParallelChunks, AreCutByCountAlone) {
  for (const int threads : thread_counts) {
    const ThreadLimit limit(threads);
    std::vector<std::size_t> end_of(4, 0);
    parallel_chunks(10, 3, [&](std::size_t begin, std::size_t end) { end_of[begin / 3] = end; });
    EXPECT_EQ(end_of, (std::vector<std::size_t>{3, 6, 9, 10}));
  }
}

// Numbers over thirty orders of magnitude: any other order of addition changes the last bits.
double awkward_sum() {
  return ordered_sum(100'000, 64, 0.0, [](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i)
      sum += std::sin(static_cast<double>(i)) * std::pow(10.0, static_cast<double>(i % 31) - 15);
    return sum;
  });
}

TEST(OrderedSum, HasTheSameBitsForAnyNumberOfThreads) {
  double first = 0;
  for (const int threads : thread_counts) {
    const ThreadLimit limit(threads);
    const double sum = awkward_sum();
    if (threads == 1) first = sum;
    EXPECT_EQ(sum, first) << threads;
  }
}

TEST(OrderedSum, OfNothingIsZero) {
  EXPECT_EQ(ordered_sum(0, 16, 0.0, [](std::size_t, std::size_t) { return 1.0; }), 0.0);
}

TEST(ParallelFor, HandsExceptionsToTheCaller) {
  for (const int threads : thread_counts) {
    const ThreadLimit limit(threads);
    const auto body = [](std::size_t i) {
      if (i == 777) throw Error(Trouble::computation, "item 777");
    };
    try {
      parallel_for(1000, body);
      FAIL() << "no exception";
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "item 777");
      EXPECT_EQ(error.trouble(), Trouble::computation);
    }
  }
}

TEST(ParallelSort, Sorts) {
  std::vector<std::uint64_t> keys(100000);
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = i * 2654435761u % 77777;  // some twice
  std::vector<std::uint64_t> expected = keys;
  std::sort(expected.begin(), expected.end());
  parallel_sort(keys);
  EXPECT_EQ(keys, expected);
}

TEST(ThreadLimit, HoldsWhileItLives) {
  const int before = thread_count();
  {
    const ThreadLimit limit(1);
    EXPECT_EQ(thread_count(), 1);
  }
  EXPECT_EQ(thread_count(), before);
}

}  // namespace
}  // namespace scan
