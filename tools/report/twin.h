// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The report for machines: every number that the page shows, under stable keys.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/report/record.h"

namespace scan {

// `report`: 1, `title`, `verdict` ("pass", "fail", "not verified"), `missing`, `left_out` (as
// left_out_effects() tells it), `provenance` (`version`, `compiler`, `seed`, `recipe`:
// fingerprint), `measurements` (as verdict.json), `deviation` (null without; `statistics`,
// `histogram`, `call_outs`: [{`number`, `position_m`, `deviation_m`, `support_m`}]), `scans`,
// `alignment`, `reconstruction`, `effects`, `artefacts`, `tradeoff`, `recipe`, and `cost`
// (`machine`, `threads`, `seconds`), which alone differs between equal runs.
nlohmann::ordered_json report_twin(const RunRecord& record);

// The figures one a line: part, name, value, unit, low, high, relation, limit, pass, count, over.
// Numbers read back to the bit; text with commas or quotes is quoted (RFC 4180).
std::string report_csv(const nlohmann::ordered_json& twin);

}  // namespace scan
