// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The page's 3D view: picture, canvas, controls, data and scripts.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tools/report/record.h"

namespace scan {

// Needs a surface or posed scans. A picture by our own ray caster stands behind the canvas where
// there is no WebGL or no script. three.js is carried deflated; the page's policy lets it run by
// its hash.
std::string viewer(const RunRecord& record, const nlohmann::ordered_json& twin,
                   std::size_t most_points);

// What the policy must allow.
std::vector<std::string_view> viewer_scripts();

}  // namespace scan
