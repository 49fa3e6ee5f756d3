// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where rays enter a box, several at once.
#pragma once

#include <cstddef>
#include <span>

namespace scan::synth {

// Side by side, by axis.
struct RaysByAxis {
  static constexpr std::size_t size = 16;
  alignas(64) double origin[3][size] = {};
  alignas(64) double direction[3][size] = {};
  alignas(64) double min_m[size] = {};
  alignas(64) double max_m[size] = {};
};

struct Box {
  double low[3], high[3];
};

// 0 for an origin inside; else what clip() (shape_rays.h) gives, to the bit, infinite if the ray
// passes the box.
void find_entries(const RaysByAxis& rays, const Box& box, double (&start_m)[RaysByAxis::size]);

// The versions that this processor can run.
using EntryKernel = void(const RaysByAxis& rays, const Box& box, double* start_m);
std::span<EntryKernel* const> entry_kernels();

}  // namespace scan::synth
