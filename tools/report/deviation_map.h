// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The surface from six sides, coloured by deviation, with the worst places numbered.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/report/record.h"

namespace scan {

// Legend, views with call-outs (each on the view that it faces most), and their table. Without
// deviations the views show plain clay; empty without a surface.
std::string deviation_map(const RunRecord& record, const nlohmann::ordered_json& twin);

}  // namespace scan
