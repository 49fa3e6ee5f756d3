// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/bending_kernel.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "libscan/core/random.h"

namespace scan {
namespace {

struct Case {
  std::array<double, 512> cube;
  AxisStencil axes[3];
  std::array<double, 64> start;
};

Case random_case() {
  Case c;
  RandomStream random(1, 0, 0);
  for (double& x : c.cube) x = random.normal();
  for (double& x : c.start) x = random.normal();
  for (AxisStencil& axis : c.axes)
    for (auto& kind : axis.taps)
      for (auto& tap : kind)
        for (double& weight : tap) weight = random.uniform();
  return c;
}

// The 125 taps of the tensor product, one by one.
double expected_at(const Case& c, int x, int y, int z) {
  double sum = 0;
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 5; ++i) {
        const auto tap = [&](int axis, int kind) {
          const int taps[3] = {i, j, k}, functions[3] = {x, y, z};
          return c.axes[axis].taps[kind][taps[axis]][functions[axis]];
        };
        double weight = 0;
        for (int a = 0; a < 3; ++a) {
          const int b = (a + 1) % 3, d = (a + 2) % 3;
          weight += tap(a, 2) * tap(b, 0) * tap(d, 0) + 2 * tap(a, 0) * tap(b, 1) * tap(d, 1);
        }
        sum += weight * c.cube[x + i + 8 * (y + j + 8 * (z + k))];
      }
  return sum;
}

TEST(BendingKernel, IsTheSumOverAllTaps) {
  const Case c = random_case();
  std::array<double, 64> sum = c.start;
  add_bending(c.cube.data(), c.axes[0], c.axes[1], c.axes[2], 0.5, sum.data());
  // 125 terms of up to 9 * 4 in size: rounding far below 1e-11.
  for (int i = 0; i < 64; ++i)
    EXPECT_NEAR(sum[i], c.start[i] + 0.5 * expected_at(c, i % 4, i / 4 % 4, i / 16), 1e-11);
}

TEST(BendingKernel, GivesTheSameBytesForAnyInstructionSet) {
  const Case c = random_case();
  std::array<double, 64> first = c.start;
  bending_kernels()[0](c.cube.data(), c.axes[0], c.axes[1], c.axes[2], 0.3, first.data());
  for (BendingKernel* kernel : bending_kernels()) {
    std::array<double, 64> sum = c.start;
    kernel(c.cube.data(), c.axes[0], c.axes[1], c.axes[2], 0.3, sum.data());
    EXPECT_EQ(std::memcmp(sum.data(), first.data(), sizeof(sum)), 0);
  }
}

}  // namespace
}  // namespace scan
