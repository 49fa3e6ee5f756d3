// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Results as JSON with stable keys. Numbers read back to the bit, what is not finite is null, poses
// are 4x4. No object here holds seconds: the files of a run do not depend on the machine.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "libscan/align/multiview.h"
#include "libscan/core/scan.h"
#include "libscan/reconstruct/surface_result.h"
#include "libscan/verify/verdict.h"

namespace scan {

// `file`, `rays` (of the grid; else points and misses together), `points`, `misses`: {reason:
// count}.
nlohmann::ordered_json scan_json(const std::string& file, const Scan& scan);

// alignment.json: `scans`: [{`file`, `world_from_scan`, `stop`, `iterations`, `rms_m`,
// `inlier_fraction_of_source`, `agreement`, `weak_directions`, `sigma_rotation_rad`,
// `sigma_translation_m`, `covariance` (6 rows: rotation rad, translation m),
// `covariance_from_guess` (the part of it along the weak directions, null where there are none),
// `covariance_centre_m`}], the last five null where the covariance is unknown; a sigma is the root
// of the sum of three variances. `covariances_between`: [{`scans` (two numbers, from 0),
// `covariance` (rows: the first's motion)}]. `pairs`: [{`source`, `target` (files), `accepted`,
// `stop`, `overlap`, `agreement`, `rms_m`}], `method`, `search`, `stop`, `rounds`, `pairs_used`.
// Throws scan::Error (usage) unless there is one file for each scan.
nlohmann::ordered_json alignment_json(std::span<const std::string> files,
                                      const MultiviewResult& result, const IcpOptions& options);

// reconstruction.json: `method`, `method_reason`, `depth` (null for methods without), `vertices`,
// `triangles`, `quads`, `components`, `watertight`, `genus`, `relative_residual`, `iterations`,
// `unknowns`, `finest_cell_m`, `sigma_m`, `smoothing_length_m`, `stop`, `invalid_points`,
// `outlying_points`, `estimated_normals`, `turned_normals`, `moved_points`.
nlohmann::ordered_json surface_json(const SurfaceResult& result);

// `name`, `value`, `unit`, `definition`, `over`, `count`, `limit`, `relation`, `pass`, `reason`,
// `interval`; limit, relation and reason are null without a limit, interval where there is none.
nlohmann::ordered_json measurement_json(const Measurement& measurement);
nlohmann::ordered_json verdict_json(const Verdict& verdict);  // `measurements`, `pass`

// Indented, a line feed at the end; bytes that are not UTF-8 (in file names) become U+FFFD.
std::string json_text(const nlohmann::ordered_json& value);
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& value);

}  // namespace scan
