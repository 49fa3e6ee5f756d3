// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Why a ray gave no point: the words that Scan::misses counts under.
#pragma once

#include <string_view>

namespace scan::reason {

inline constexpr std::string_view no_signal = "no signal";  // nothing above the noise
inline constexpr std::string_view saturated = "saturated";  // the peak is clipped
inline constexpr std::string_view ambiguous = "ambiguous";  // no unique peak, match or wrap
inline constexpr std::string_view inconsistent =
    "inconsistent";  // left-right check, frequencies, stripe shape
inline constexpr std::string_view out_of_range = "out of range";  // outside the device's limits
inline constexpr std::string_view undetermined = "undetermined";  // the geometry gives no depth
inline constexpr std::string_view border = "border";              // peak cut by the image's edge

}  // namespace scan::reason
