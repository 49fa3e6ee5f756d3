// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/bending_kernel.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "libscan/core/random.h"

namespace scan {
namespace {

template <class Real>
struct Case {
  std::array<Real, 512> cube;
  AxisStencil<Real> axes[3];
  std::array<Real, 64> start;
};

template <class Real>
Case<Real> random_case() {
  Case<Real> c;
  RandomStream random(1, 0, 0);
  for (Real& x : c.cube) x = static_cast<Real>(random.normal());
  for (Real& x : c.start) x = static_cast<Real>(random.normal());
  for (AxisStencil<Real>& axis : c.axes)
    for (auto& kind : axis.taps)
      for (auto& tap : kind)
        for (Real& weight : tap) weight = static_cast<Real>(random.uniform());
  return c;
}

// The 125 taps of the tensor product, one by one.
template <class Real>
double expected_at(const Case<Real>& c, int x, int y, int z) {
  double sum = 0;
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 5; ++i) {
        const auto tap = [&](int axis, int kind) -> double {
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

template <class Real>
class BendingKernelOf : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(BendingKernelOf, Reals);

TYPED_TEST(BendingKernelOf, IsTheSumOverAllTaps) {
  using Real = TypeParam;
  const Case<Real> c = random_case<Real>();
  std::array<Real, 64> sum = c.start;
  add_bending<Real>(c.cube.data(), c.axes[0], c.axes[1], c.axes[2], Real{0.5}, sum.data());
  // 125 terms of up to 9 * 4 in size, hence sums below 2,250 on the way, each rounded some 20
  // times: 45,000 units of the last place, were all at their worst.
  const double tolerance = 45e3 * std::numeric_limits<Real>::epsilon() / 2;
  for (int i = 0; i < 64; ++i)
    EXPECT_NEAR(sum[i], c.start[i] + 0.5 * expected_at(c, i % 4, i / 4 % 4, i / 16), tolerance);
}

TYPED_TEST(BendingKernelOf, GivesTheSameBytesForAnyInstructionSet) {
  using Real = TypeParam;
  const Case<Real> c = random_case<Real>();
  const Real scale{0.3f};
  std::array<Real, 64> first = c.start;
  bending_kernels<Real>()[0](c.cube.data(), c.axes[0], c.axes[1], c.axes[2], scale, first.data());
  for (BendingKernel<Real>* kernel : bending_kernels<Real>()) {
    std::array<Real, 64> sum = c.start;
    kernel(c.cube.data(), c.axes[0], c.axes[1], c.axes[2], scale, sum.data());
    EXPECT_EQ(std::memcmp(sum.data(), first.data(), sizeof(sum)), 0);
  }
}

}  // namespace
}  // namespace scan
