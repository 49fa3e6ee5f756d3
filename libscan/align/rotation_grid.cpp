// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/rotation_grid.h"

#include <cmath>
#include <numbers>

namespace scan {

std::vector<Eigen::Quaterniond> rotation_grid(std::size_t count) {
  // psi^4 = psi + 4 and phi = sqrt 2 (Alexa 2022, section 3).
  constexpr double phi = std::numbers::sqrt2, psi = 1.533751168755204288118041;
  std::vector<Eigen::Quaterniond> rotations;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = static_cast<double>(i) + 0.5;
    const double t = s / static_cast<double>(count);
    const double d = 2 * std::numbers::pi * s;
    const double r = std::sqrt(t), big_r = std::sqrt(1 - t);
    rotations.emplace_back(big_r * std::cos(d / psi), r * std::sin(d / phi), r * std::cos(d / phi),
                           big_r * std::sin(d / psi));
  }
  return rotations;
}

}  // namespace scan
