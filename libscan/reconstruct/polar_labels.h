// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which of the balls that touch a surface lie inside it.
#pragma once

#include <span>
#include <vector>

#include "libscan/reconstruct/power_diagram.h"

namespace scan {

// Two balls and how surely they lie on the same side of the surface, or on different sides; 0: they
// meet without saying.
struct PolarTie {
  std::uint32_t first = 0, second = 0;
  double certainty = 0;  // at most 1
  bool is_same_side = true;
};

// How surely two balls lie on the same side: the cosine of the angle between their radii where
// their spheres meet, 0 at least. Balls of two sides of a surface meet at its points only.
double same_side_certainty(const Ball& a, const Ball& b);

// Whether each ball lies inside, from the outer ones on, the surest next (Amenta, Choi and Kolluri
// 2001, section 3.3). Balls that no tie reaches lie beyond a layer of points that scatter: on the
// other side than those that they meet.
std::vector<char> label_inside(std::size_t balls, std::span<const PolarTie> ties,
                               std::span<const char> is_outer);

}  // namespace scan
