// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Constants and conversions at the border between people and SI.
#pragma once

#include <numbers>

namespace scan {

inline constexpr double speed_of_light_m_s = 299'792'458.0;

constexpr double rad_from_deg(double degrees) {
  return degrees * (std::numbers::pi / 180);
}
constexpr double deg_from_rad(double radians) {
  return radians * (180 / std::numbers::pi);
}
constexpr double m_from_mm(double millimetres) {
  return millimetres * 1e-3;
}
constexpr double mm_from_m(double metres) {
  return metres * 1e3;
}

}  // namespace scan
