// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Phasors of many paths at once.
#pragma once

#include <cstddef>
#include <span>

namespace scan::synth {

// real[i] + i imaginary[i] = length[i] exp(2 pi i turns_per_m path_m[i]), right to 5e-13 of the
// length and the rounding of the number of turns.
void phasors(double turns_per_m, std::span<const double> path_m, std::span<const double> length,
             std::span<double> real, std::span<double> imaginary);

// The versions that this processor can run.
using PhasorKernel = void(double turns_per_m, const double* path_m, const double* length,
                          double* real, double* imaginary, std::size_t count);
std::span<PhasorKernel* const> phasor_kernels();

}  // namespace scan::synth
