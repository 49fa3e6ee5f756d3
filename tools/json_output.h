// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Results as JSON, with the keys that others rely on (stable from the first version).
//
// Nothing here depends on time or threads: files in a run folder are the same for equal runs.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "libscan/align/multiview.h"
#include "libscan/core/scan.h"
#include "libscan/reconstruct/surface_result.h"
#include "libscan/verify/verdict.h"

namespace scan {

// {file, rays, points, misses: {reason: count}}
nlohmann::ordered_json scan_json(const std::string& file, const Scan& scan);

// {scans: [{file, world_from_scan: 4x4, stop, iterations, rms_m, inlier_fraction_of_source,
//   weak_directions}], method, search, stop, rounds, pairs_used}
nlohmann::ordered_json alignment_json(const MultiviewResult& result,
                                      const std::vector<std::string>& files,
                                      const IcpOptions& options);

// {method, depth, vertices, triangles, components, watertight, genus, boundary_edges,
//   relative_residual, iterations, unknowns, stop, finest_cell_m}
nlohmann::ordered_json surface_json(const SurfaceResult& result, const std::string& method,
                                    int depth);

// {measurements: [{name, value, unit, over, count, limit, relation, pass, reason}], pass}; NaN is null
nlohmann::ordered_json verdict_json(const Verdict& verdict);

// Two-space indent and a final newline.
std::string json_text(const nlohmann::ordered_json& json);
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace scan
