// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/block_reading.h"

#include "libscan/core/vector_math.h"

namespace scan::synth {
namespace {

using Kind = ReadingLaw::Kind;

SCAN_INLINE double lower(double a, double b) {
  return a < b ? a : b;
}
SCAN_INLINE double higher(double a, double b) {
  return a < b ? b : a;
}

// Abramowitz and Stegun 26.2.49 with gamma_n = a h^n, h = 1 / standard deviation, a = mean h^2;
// times the standard deviation.
SCAN_INLINE float skewness(float a, float h, float x) {
  const float x2 = x * x;
  const float first = (x2 - 1) * (1.0F / 6);
  const float second = x * (x2 * (1.0F / 24 - a * (1.0F / 18)) + (a * (5.0F / 36) - 1.0F / 8));
  const float third = x2 * x2 * (1.0F / 120 + a * (a * (1.0F / 27) - 1.0F / 24)) +
                      x2 * (a * (5.0F / 24 - a * (53.0F / 324)) - 1.0F / 20) +
                      (1.0F / 40 + a * (a * (17.0F / 324) - 1.0F / 12));
  return a * (first + h * (second + h * third));
}

// What the noise adds need be right to a millionth of itself only.
template <Kind kind>
SCAN_INLINE double detected_e(const ReadingLaw& law, double expected_e, float x) {
  if constexpr (kind == Kind::exact) return expected_e;
  const auto mean = static_cast<float>(law.shot * expected_e);
  const float variance = mean + static_cast<float>(law.variance_e2);
  const float h = inverse_sqrt(variance);
  const float noise_e = variance * h * x + skewness(mean * h * h, h, x);
  const double electrons = expected_e + static_cast<double>(noise_e);
  if constexpr (kind == Kind::count)
    return static_cast<double>(static_cast<std::int32_t>(electrons + 0.5));
  return electrons;
}

template <Kind kind>
SCAN_INLINE bool read_all(const ReadingLaw& law, const double* __restrict expected_e,
                          const float* __restrict normals, std::uint16_t* __restrict readings,
                          std::size_t count) {
  std::uint64_t outside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double e = expected_e[i];
    outside |= e >= law.least_e ? 0u : 1u;
    outside |= e <= law.most_e ? 0u : 1u;
    const float x = kind == Kind::exact ? 0 : normals[i];
    const double detected = detected_e<kind>(law, lower(higher(e, law.low_e), law.high_e), x);
    const double dn = detected * law.dn_per_e + law.offset_dn;
    readings[i] = static_cast<std::uint16_t>(
        static_cast<std::int32_t>(lower(higher(dn, 0), law.largest_dn) + 0.5));
  }
  return outside == 0;
}

SCAN_INLINE bool read_any(const ReadingLaw& law, const double* expected_e, const float* normals,
                          std::uint16_t* readings, std::size_t count) {
  if (law.kind == Kind::exact)
    return read_all<Kind::exact>(law, expected_e, normals, readings, count);
  if (law.kind == Kind::sum) return read_all<Kind::sum>(law, expected_e, normals, readings, count);
  return read_all<Kind::count>(law, expected_e, normals, readings, count);
}

bool read_plain(const ReadingLaw& law, const double* expected_e, const float* normals,
                std::uint16_t* readings, std::size_t count) {
  return read_any(law, expected_e, normals, readings, count);
}
SCAN_AVX2 bool read_avx2(const ReadingLaw& law, const double* expected_e, const float* normals,
                         std::uint16_t* readings, std::size_t count) {
  return read_any(law, expected_e, normals, readings, count);
}
SCAN_AVX512 bool read_avx512(const ReadingLaw& law, const double* expected_e, const float* normals,
                             std::uint16_t* readings, std::size_t count) {
  return read_any(law, expected_e, normals, readings, count);
}

const Versions<ReadingKernel> versions(read_plain, read_avx2, read_avx512);

}  // namespace

bool read_block(const ReadingLaw& law, std::span<const double> expected_e,
                std::span<const float> normals, std::span<std::uint16_t> readings) {
  return versions.fastest()(law, expected_e.data(), normals.data(), readings.data(),
                            readings.size());
}

std::span<ReadingKernel* const> reading_kernels() {
  return versions.all();
}

}  // namespace scan::synth
