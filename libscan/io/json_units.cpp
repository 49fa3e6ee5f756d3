// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/json_units.h"

#include "libscan/core/units.h"

namespace scan {
namespace {

const JsonUnits length_units = {{"_m", 1}, {"_mm", 1e-3}, {"_um", 1e-6}, {"_nm", 1e-9}};
const JsonUnits angle_units = {{"_rad", 1}, {"_deg", rad_from_deg(1)}};
const JsonUnits time_units = {{"_s", 1}, {"_ms", 1e-3}, {"_us", 1e-6}, {"_ns", 1e-9}};
const JsonUnits frequency_units = {{"_hz", 1}, {"_mhz", 1e6}};

}  // namespace

const JsonUnits& units_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::length:
      return length_units;
    case Quantity::angle:
      return angle_units;
    case Quantity::time:
      return time_units;
    case Quantity::frequency:
      break;
  }
  return frequency_units;
}

std::vector<std::string> unit_suffixes(Quantity quantity) {
  std::vector<std::string> suffixes;
  for (const auto& [suffix, scale] : units_of(quantity))
    suffixes.insert(scale == 1 ? suffixes.begin() : suffixes.end(), suffix);
  return suffixes;
}

}  // namespace scan
