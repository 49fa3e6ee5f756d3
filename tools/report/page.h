// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The report: one self-contained HTML page that opens from disk without network.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/report/record.h"

namespace scan {

// The page stays below this: what is shown in 3D is thinned until it does.
inline constexpr std::size_t most_page_bytes = 2'000'000;

// `twin` is the record's report_twin(), whose numbers the page shows. Times, machine and threads
// stand in one element, <table id="seconds">, on a line of its own.
std::string report_page(const RunRecord& record, const nlohmann::ordered_json& twin);

}  // namespace scan
