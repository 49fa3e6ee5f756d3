// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/json_output.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "libscan/io/atomic_file.h"
#include "libscan/io/shape_json.h"

namespace scan {

using nlohmann::ordered_json;

ordered_json scan_json(const std::string& file, const Scan& scan) {
  std::size_t rays = scan.cloud.size();
  for (const auto& [reason, count] : scan.misses) rays += count;
  return {{"file", file}, {"rays", rays}, {"points", scan.cloud.size()}, {"misses", scan.misses}};
}

ordered_json alignment_json(const MultiviewResult& result, const std::vector<std::string>& files,
                            const IcpOptions& options) {
  ordered_json scans = ordered_json::array();
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    const ScanPose& scan = result.scans[i];
    scans.push_back({{"file", files[i]},
                     {"world_from_scan", to_json(scan.world_from_scan)},
                     {"stop", name_of(scan.stop)},
                     {"iterations", scan.iterations},
                     {"rms_m", scan.rms_m},
                     {"inlier_fraction_of_source", scan.inlier_fraction_of_source},
                     {"weak_directions", scan.weak_directions}});
  }
  return {{"scans", scans},
          {"method", name_of(options.method)},
          {"search", name_of(options.search)},
          {"stop", name_of(result.stop)},
          {"rounds", result.rounds},
          {"pairs_used", result.pairs_used}};
}

ordered_json surface_json(const SurfaceResult& result, const std::string& method, int depth) {
  const EdgeCensus census = edge_census(result.surface);
  return {{"method", method},
          {"depth", method == "ssd" ? ordered_json(depth) : ordered_json(nullptr)},
          {"vertices", result.surface.vertices.size()},
          {"triangles", result.surface.triangles.size()},
          {"components", census.components},
          {"watertight", census.watertight},
          {"genus", census.watertight ? ordered_json(census.genus) : ordered_json(nullptr)},
          {"boundary_edges", census.boundary_edges},
          {"relative_residual", result.relative_residual},
          {"iterations", result.iterations},
          {"unknowns", result.unknowns},
          {"stop", name_of(result.stop)},
          {"finest_cell_m", result.finest_cell_m}};
}

ordered_json verdict_json(const Verdict& verdict) {
  ordered_json measurements = ordered_json::array();
  for (const Measurement& m : verdict.measurements) {
    const auto finite = [](double v) { return std::isfinite(v) ? ordered_json(v) : nullptr; };
    measurements.push_back({{"name", m.name},
                            {"value", finite(m.value)},
                            {"unit", m.unit},
                            {"over", m.over},
                            {"count", m.count},
                            {"limit", m.limit ? finite(*m.limit) : ordered_json(nullptr)},
                            {"relation", m.relation},
                            {"pass", m.pass},
                            {"reason", m.reason}});
  }
  return {{"measurements", measurements}, {"pass", verdict.pass}};
}

std::string json_text(const ordered_json& json) { return json.dump(2) + "\n"; }

void write_json(const std::filesystem::path& path, const ordered_json& json) {
  write_file(path, json_text(json));
}

}  // namespace scan
