// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phasors.h"

#include "libscan/core/vector_math.h"

namespace scan::synth {
namespace {

SCAN_INLINE void turn_all(double turns_per_m, const double* __restrict path_m,
                          const double* __restrict length, double* __restrict real,
                          double* __restrict imaginary, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const Turned angle = turned(turns_per_m * path_m[i]);
    real[i] = length[i] * angle.cosine;
    imaginary[i] = length[i] * angle.sine;
  }
}

void turn_plain(double turns_per_m, const double* path_m, const double* length, double* real,
                double* imaginary, std::size_t count) {
  turn_all(turns_per_m, path_m, length, real, imaginary, count);
}
SCAN_AVX2 void turn_avx2(double turns_per_m, const double* path_m, const double* length,
                         double* real, double* imaginary, std::size_t count) {
  turn_all(turns_per_m, path_m, length, real, imaginary, count);
}
SCAN_AVX512 void turn_avx512(double turns_per_m, const double* path_m, const double* length,
                             double* real, double* imaginary, std::size_t count) {
  turn_all(turns_per_m, path_m, length, real, imaginary, count);
}

const Versions<PhasorKernel> versions(turn_plain, turn_avx2, turn_avx512);

}  // namespace

void phasors(double turns_per_m, std::span<const double> path_m, std::span<const double> length,
             std::span<double> real, std::span<double> imaginary) {
  versions.fastest()(turns_per_m, path_m.data(), length.data(), real.data(), imaginary.data(),
                     path_m.size());
}

std::span<PhasorKernel* const> phasor_kernels() {
  return versions.all();
}

}  // namespace scan::synth
