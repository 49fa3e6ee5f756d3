// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/random.h"

#include <cmath>
#include <numbers>

namespace scan {
namespace {

// Knuth's product of uniforms, in log space one draw at a time; for small means.
std::uint64_t poisson_by_product(RandomStream& random, double mean) {
  const double limit = std::exp(-mean);
  std::uint64_t count = 0;
  double product = 1;
  while ((product *= random.uniform()) > limit) ++count;
  return count;
}

// What Stirling's formula lacks: log k! - log(sqrt(2 pi k) (k/e)^k), k >= 1. The series' next term
// is 1 / (1188 k^9), below 1e-14 from 16 on.
double stirling_error(double k) {
  if (k >= 16) {
    const double k2 = k * k;
    return (1.0 / 12 - (1.0 / 360 - (1.0 / 1260 - 1.0 / 1680 / k2) / k2) / k2) / k;
  }
  double log_factorial = 0;
  for (int i = 2; i <= static_cast<int>(k); ++i) log_factorial += std::log(i);
  return log_factorial - 0.5 * std::log(2 * std::numbers::pi * k) - k * (std::log(k) - 1);
}

// k log(k / mean) + mean - k, free of cancellation where k is near the mean.
double deviance(double k, double mean) {
  const double x = (k - mean) / mean;
  if (std::abs(x) > 0.1) return k * std::log(k / mean) + mean - k;
  double sum = 0, power = x * x;  // mean ((1 + x) log(1 + x) - x) = mean sum (-x)^n / (n (n - 1))
  for (int n = 2; n < 18; ++n, power *= -x) sum += power / (n * (n - 1));
  return mean * sum;
}

// By the saddle point (Loader 2000, "Fast and accurate computation of binomial probabilities"):
// right to rounding for every mean, where k log(mean) - mean - log k! loses digits as the mean
// grows.
double log_poisson_probability(double k, double mean) {
  if (k == 0) return -mean;
  return -stirling_error(k) - deviance(k, mean) - 0.5 * std::log(2 * std::numbers::pi * k);
}

// Transformed rejection with squeeze, PTRS (Hormann 1993, "The transformed rejection method for
// generating Poisson random variables"), exact for mean >= 10.
std::uint64_t poisson_by_rejection(RandomStream& random, double mean) {
  const double b = 0.931 + 2.53 * std::sqrt(mean);
  const double a = -0.059 + 0.02483 * b;
  const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
  const double v_r = 0.9277 - 3.6224 / (b - 2);
  while (true) {
    const double u = random.uniform() - 0.5;
    const double v = random.uniform();
    const double us = 0.5 - std::abs(u);
    if (!(us > 0)) continue;
    const double k = std::floor((2 * a / us + b) * u + mean + 0.43);
    if (us >= 0.07 && v <= v_r) return static_cast<std::uint64_t>(k);
    if (k < 0 || (us < 0.013 && v > us)) continue;
    if (std::log(v * inverse_alpha / (a / (us * us) + b)) <= log_poisson_probability(k, mean))
      return static_cast<std::uint64_t>(k);
  }
}

}  // namespace

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> c,
                                        std::array<std::uint32_t, 2> k) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = 0xD2511F53ull * c[0];
    const std::uint64_t p1 = 0xCD9E8D57ull * c[2];
    c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ k[0], static_cast<std::uint32_t>(p1),
         static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ k[1], static_cast<std::uint32_t>(p0)};
    k[0] += 0x9E3779B9u;
    k[1] += 0xBB67AE85u;
  }
  return c;
}

RandomStream::RandomStream(std::uint64_t seed, std::uint32_t scan, std::uint64_t ray,
                           std::uint32_t block)
    : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
      counter_{block, scan, static_cast<std::uint32_t>(ray), static_cast<std::uint32_t>(ray >> 32)},
      block_{} {}

std::uint32_t RandomStream::bits32() {
  if (used_ == 4) {
    block_ = philox4x32(counter_, key_);
    ++counter_[0];
    used_ = 0;
  }
  return block_[used_++];
}

double RandomStream::uniform() {
  const std::uint64_t high = bits32() >> 5, low = bits32() >> 6;
  return static_cast<double>(high << 26 | low) * 0x1p-53;
}

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_normal_;
  }
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  const double angle = 2 * std::numbers::pi * uniform();
  spare_normal_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

std::uint64_t RandomStream::poisson(double mean) {
  if (!(mean > 0)) return 0;
  return mean < 12 ? poisson_by_product(*this, mean) : poisson_by_rejection(*this, mean);
}

}  // namespace scan
