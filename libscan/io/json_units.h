// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The units that the keys of our JSON carry: radius_mm, step_deg, exposure_ms, frequencies_mhz.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace scan {

enum class Quantity { length, angle, time, frequency };

using JsonUnits = std::map<std::string, double>;  // a key's suffix -> its size in SI

const JsonUnits& units_of(Quantity quantity);

// "_m", "_mm", ...: that of SI first.
std::vector<std::string> unit_suffixes(Quantity quantity);

}  // namespace scan
