// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phasors.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>
#include <vector>

namespace scan::synth {
namespace {

struct Paths {
  std::vector<double> path_m, length;
};

Paths some_paths() {
  Paths paths;
  for (int i = 0; i < 5003; ++i) {
    paths.path_m.push_back(0.037 * i);
    paths.length.push_back(1 + i % 7);
  }
  return paths;
}

// 4e-13 by the series; up to 50 turns of 2 pi are rounded in both.
TEST(Phasors, AreTurnedByTheirPaths) {
  const auto [path_m, length] = some_paths();
  std::vector<double> real(path_m.size()), imaginary(path_m.size());
  for (const double turns_per_m : {0.27, -0.05, 0.0}) {
    phasors(turns_per_m, path_m, length, real, imaginary);
    for (std::size_t i = 0; i < path_m.size(); ++i) {
      const auto phasor = std::polar(length[i], 2 * std::numbers::pi * turns_per_m * path_m[i]);
      ASSERT_NEAR(real[i], phasor.real(), 1e-12 * length[i]);
      ASSERT_NEAR(imaginary[i], phasor.imag(), 1e-12 * length[i]);
    }
  }
}

TEST(Phasors, HaveTheSameBytesByEveryKernel) {
  const auto [path_m, length] = some_paths();
  const std::size_t n = path_m.size();
  std::vector<double> real(n), imaginary(n), other_real(n), other_imaginary(n);
  phasor_kernels().front()(0.27, path_m.data(), length.data(), real.data(), imaginary.data(), n);
  for (PhasorKernel* const kernel : phasor_kernels()) {
    kernel(0.27, path_m.data(), length.data(), other_real.data(), other_imaginary.data(), n);
    EXPECT_EQ(real, other_real);
    EXPECT_EQ(imaginary, other_imaginary);
  }
}

}  // namespace
}  // namespace scan::synth
