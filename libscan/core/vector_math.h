// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Elementary functions without branches or tables, for loops that the compiler turns into vector
// instructions. The same bits on every processor, unlike those of the C library.
#pragma once

#include <bit>
#include <cstdint>

#include "libscan/core/instruction_sets.h"

namespace scan {

// 1 / sqrt(x) for normal x > 0 to four roundings, finite for 0: Newton's iteration
// y (3 - x y^2) / 2 from a first guess by the exponent, off by at most 3.5 %; errors go
// e -> 3/2 e^2, that is 1.8e-3, 5e-6, 4e-11.
SCAN_INLINE float inverse_sqrt(float x) {
  float y = std::bit_cast<float>(0x5f3759dfu - (std::bit_cast<std::uint32_t>(x) >> 1));
  const float half = 0.5F * x;
  y = y * (1.5F - half * y * y);
  y = y * (1.5F - half * y * y);
  return y * (1.5F - half * y * y);
}

struct Turned {
  double cosine, sine;
};

// Cosine and sine of (quarters + t) quarter turns, t in [-1/2, 1/2]; of `quarters` the lowest two
// bits count. Taylor's series, whose next terms at pi / 4 are x^14 / 14! = 4e-13 and
// x^15 / 15! = 2e-14.
SCAN_INLINE Turned turned(std::uint64_t quarters, double t) {
  const double x = 1.5707963267948966 * t, z = x * x;
  const double sine =
      x +
      x * z *
          (-1.0 / 6 +
           z * (1.0 / 120 + z * (-1.0 / 5040 + z * (1.0 / 362880 + z * (-1.0 / 39916800 +
                                                                        z * (1.0 / 6227020800))))));
  const double cosine =
      1 + z * (-1.0 / 2 +
               z * (1.0 / 24 + z * (-1.0 / 720 + z * (1.0 / 40320 + z * (-1.0 / 3628800 +
                                                                         z * (1.0 / 479001600))))));
  const std::uint64_t odd = 0 - (quarters & 1);  // all bits
  const std::uint64_t c = std::bit_cast<std::uint64_t>(cosine);
  const std::uint64_t s = std::bit_cast<std::uint64_t>(sine);
  const std::uint64_t along = (c & ~odd) | (s & odd), across = (s & ~odd) | (c & odd);
  return {std::bit_cast<double>(along ^ (((quarters + 1) & 2) << 62)),
          std::bit_cast<double>(across ^ ((quarters & 2) << 62))};
}

// The same of any number of turns up to 2^50: an angle off by half a unit of the last place of
// `turns` is off as far here.
SCAN_INLINE Turned turned(double turns) {
  constexpr double whole = 0x1.8p52;  // its last bit counts 1
  const double quarters = 4 * turns;
  const double shifted = quarters + whole;
  return turned(std::bit_cast<std::uint64_t>(shifted), quarters - (shifted - whole));
}

}  // namespace scan
