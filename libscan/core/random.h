// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Random numbers addressed by (seed, scan, ray): each address has a stream of its own, so results
// do not depend on threads or on the order of work.
//
// Philox4x32-10, a counter-based generator (Salmon, Moraes, Dror, Shaw, SC 2011). The
// distributions are our own, since the standard fixes engines only.
#pragma once

#include <array>
#include <cstdint>

namespace scan {

class RandomStream {
 public:
  // `scan` and `ray` may be any numbers that name the item of work; streams of different addresses
  // are independent. `block`: where in the stream to begin, in blocks of four words.
  RandomStream(std::uint64_t seed, std::uint32_t scan, std::uint64_t ray, std::uint32_t block = 0);

  std::uint32_t bits32();
  double uniform();                    // in [0, 1), 53 bits
  double normal();                     // mean 0, variance 1 (Box and Muller)
  std::uint64_t poisson(double mean);  // exact for every finite mean >= 0

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> block_;
  unsigned used_ = 4;
  double spare_normal_ = 0;
  bool has_spare_ = false;
};

// One block of the generator; public so that it can be checked against published vectors.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

}  // namespace scan
