// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// H21: the memory of an alignment grows with its points and is given back.
#include <gtest/gtest.h>
#include <malloc.h>

#include "libscan/core/cost.h"
#include "libscan/core/parallel.h"
#include "tests/align/icp_methods.h"
#include "tests/align/test_clouds.h"

namespace scan {
namespace {

// What a call takes beyond what was there before.
double peak_mib(std::size_t points, IcpMethod method) {
  const auto [source, target] = test::split(test::bumpy_surface(points, 1), 2);
  malloc_trim(0);  // pages of the call before would hide what this one takes
  restart_peak_memory();
  const double before_mib = peak_memory_mib();
  icp(source, target, Pose::Identity(), {.method = method, .max_iterations = 5});
  return peak_memory_mib() - before_mib;
}

// Four times the points: vectors that double as they grow do so alike, and what does not grow with
// the points only lowers the larger peak's share. The allocator has up to some MiB of its own to
// hand out, less of it left the second time; a part that grew with the square would take 16 times
// as much. On one thread, as what the allocator holds back of two depends on when they allocate.
TEST(AlignMemory, IsLinearInThePoints) {
  const ThreadLimit limit(1);
  for (const IcpMethod method : {IcpMethod::symmetric, IcpMethod::plane_to_plane}) {
    const double few = peak_mib(40'000, method), many = peak_mib(160'000, method);
    if (few <= 0) GTEST_SKIP() << "this kernel does not let a process reset its peak memory";
    EXPECT_LT(many, 4 * few + 8) << name_of(method);
    // Points, normals, fits, search and pairs, for each of both clouds' points.
    EXPECT_LT(many, 160'000 * 400 / 0x1p20) << name_of(method);
  }
}

// A leak of one byte for each of the 100 points would show as 100 kB.
TEST(AlignMemory, IsFlatOverManyCalls) {
  const ThreadLimit limit(1);
  const auto [source, target] = test::split(test::bumpy_surface(200, 1), 2);
  const auto call = [&](int times) {
    for (int i = 0; i < times; ++i) icp(source, target, Pose::Identity(), {.max_iterations = 5});
    return mallinfo2().uordblks;
  };
  const std::size_t after_ten = call(10);
  EXPECT_LT(call(1000), after_ten + 10'000);
}

}  // namespace
}  // namespace scan
