// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the page's 3D view shows, as JSON (read by tools/report/viewer.js and its helpers).
#pragma once

#include <nlohmann/json.hpp>

#include "tools/report/record.h"

namespace scan {

inline constexpr std::size_t most_page_points = 100'000;

// `surface`: the vertices that are shown (point_pack.h), the worst deviations among them; null
// without one. `scans`: [{`name`, `points`, `viewpoint_m`, `reach_m` and `aim`: mean distance and
// direction of its points from there, scanner frame}]. `steps`: [{`step`, `poses`: as in
// pose_trace.json, `off_m`: mean distance of the scans' middles from where they come to lie}].
// `limit_m`, `colours`: the diverging scale from -limit_m to limit_m. `box`: corners of everything,
// world. `call_outs`: as in the twin, with the surface's normal there. At most `most_points`
// points, three fifths of them on the surface.
nlohmann::ordered_json scene_data(const RunRecord& record, const nlohmann::ordered_json& twin,
                                  std::size_t most_points = most_page_points);

}  // namespace scan
