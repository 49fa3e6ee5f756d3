// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/json_output.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/shape_json.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json scan_pose_json(const std::string& file, const ScanPose& scan) {
  return {{"file", file},
          {"world_from_scan", to_json(scan.world_from_scan)},
          {"stop", name_of(scan.stop)},
          {"iterations", scan.iterations},
          {"rms_m", number(scan.rms_m)},
          {"inlier_fraction_of_source", number(scan.inlier_fraction_of_source)},
          {"agreement", number(scan.agreement)},
          {"weak_directions", scan.weak_directions}};
}

}  // namespace

ordered_json scan_json(const std::string& file, const Scan& scan) {
  std::size_t rays = std::size_t{scan.grid.rows} * scan.grid.columns;
  if (rays == 0) {
    rays = scan.cloud.size();
    for (const auto& [reason, count] : scan.misses) rays += count;
  }
  return {{"file", file},
          {"rays", rays},
          {"points", scan.cloud.size()},
          {"misses", ordered_json(scan.misses)}};
}

ordered_json alignment_json(std::span<const std::string> files, const MultiviewResult& result,
                            const IcpOptions& options) {
  if (files.size() != result.scans.size())
    throw Error(Trouble::usage, "alignment: " + std::to_string(files.size()) + " files for " +
                                    std::to_string(result.scans.size()) + " scans");
  ordered_json scans = ordered_json::array();
  for (std::size_t i = 0; i < files.size(); ++i)
    scans.push_back(scan_pose_json(files[i], result.scans[i]));
  return {{"scans", scans},
          {"method", name_of(options.method)},
          {"search", name_of(options.search)},
          {"stop", name_of(result.stop)},
          {"rounds", result.rounds},
          {"pairs_used", result.pairs_used}};
}

ordered_json surface_json(const std::string& method, std::optional<int> depth,
                          const SurfaceResult& result) {
  const EdgeCensus census = edge_census(result.surface);
  return {{"method", method},
          {"depth", depth ? ordered_json(*depth) : ordered_json(nullptr)},
          {"vertices", result.surface.vertices.size()},
          {"triangles", result.surface.triangles.size()},
          {"components", census.components},
          {"watertight", census.watertight},
          {"genus", census.genus},
          {"relative_residual", number(result.relative_residual)},
          {"iterations", result.iterations},
          {"unknowns", result.unknowns},
          {"finest_cell_m", number(result.finest_cell_m)},
          {"stop", name_of(result.stop)},
          {"invalid_points", result.invalid_points}};
}

ordered_json measurement_json(const Measurement& m) {
  const auto if_limited = [&](const ordered_json& value) {
    return m.limit ? value : ordered_json(nullptr);
  };
  return {{"name", m.name},
          {"value", number(m.value)},
          {"unit", m.unit},
          {"over", m.over},
          {"count", m.count},
          {"limit", if_limited(number(m.limit.value_or(0)))},
          {"relation", if_limited(m.relation)},
          {"pass", m.pass},
          {"reason", if_limited(m.reason)}};
}

ordered_json verdict_json(const Verdict& verdict) {
  ordered_json measurements = ordered_json::array();
  for (const Measurement& measurement : verdict.measurements)
    measurements.push_back(measurement_json(measurement));
  return {{"measurements", measurements}, {"pass", verdict.pass}};
}

std::string json_text(const ordered_json& value) {
  return value.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

void write_json(const std::filesystem::path& path, const ordered_json& value) {
  write_file(path, json_text(value));
}

}  // namespace scan
