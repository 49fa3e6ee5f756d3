// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/json_output.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/shape_json.h"
#include "libscan/verify/definitions.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json rows_of(const Matrix6& matrix) {
  ordered_json rows = ordered_json::array();
  for (const auto& row : matrix.rowwise())
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  return rows;
}

void add_covariance(const ScanPose& scan, ordered_json& json) {
  for (const char* key : {"sigma_rotation_rad", "sigma_translation_m", "covariance",
                          "covariance_from_guess", "covariance_centre_m"})
    json[key] = nullptr;
  if (!scan.covariance) return;
  json["sigma_rotation_rad"] = std::sqrt(scan.covariance->topLeftCorner<3, 3>().trace());
  json["sigma_translation_m"] = std::sqrt(scan.covariance->bottomRightCorner<3, 3>().trace());
  json["covariance"] = rows_of(*scan.covariance);
  if (scan.covariance_from_guess)
    json["covariance_from_guess"] = rows_of(*scan.covariance_from_guess);
  json["covariance_centre_m"] =
      std::vector<double>(scan.covariance_centre.begin(), scan.covariance_centre.end());
}

ordered_json edge_json(std::span<const std::string> files, const ScanEdge& edge) {
  return {{"source", files[edge.source]},    {"target", files[edge.target]},
          {"accepted", edge.accepted},       {"stop", name_of(edge.stop)},
          {"overlap", number(edge.overlap)}, {"agreement", number(edge.agreement)},
          {"rms_m", number(edge.rms_m)}};
}

ordered_json scan_pose_json(const std::string& file, const ScanPose& scan) {
  ordered_json json = {{"file", file},
                       {"world_from_scan", to_json(scan.world_from_scan)},
                       {"stop", name_of(scan.stop)},
                       {"iterations", scan.iterations},
                       {"rms_m", number(scan.rms_m)},
                       {"inlier_fraction_of_source", number(scan.inlier_fraction_of_source)},
                       {"agreement", number(scan.agreement)},
                       {"weak_directions", scan.weak_directions}};
  add_covariance(scan, json);
  return json;
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
  ordered_json pairs = ordered_json::array();
  for (const ScanEdge& edge : result.edges) pairs.push_back(edge_json(files, edge));
  ordered_json between = ordered_json::array();
  for (const CommonCovariance& couple : result.covariances_between)
    between.push_back(
        {{"scans", {couple.first, couple.second}}, {"covariance", rows_of(couple.covariance)}});
  return {{"scans", scans},
          {"covariances_between", between},
          {"pairs", pairs},
          {"method", name_of(options.method)},
          {"search", name_of(options.search)},
          {"stop", name_of(result.stop)},
          {"rounds", result.rounds},
          {"pairs_used", result.pairs_used}};
}

ordered_json surface_json(const SurfaceResult& result) {
  const EdgeCensus census = edge_census(result.surface);
  return {{"method", result.method},
          {"method_reason", result.method_reason},
          {"depth", result.depth > 0 ? ordered_json(result.depth) : ordered_json(nullptr)},
          {"vertices", result.surface.vertices.size()},
          {"triangles", result.surface.triangles.size()},
          {"quads", result.surface.quads},
          {"components", census.components},
          {"watertight", census.watertight},
          {"genus", census.genus},
          {"relative_residual", number(result.relative_residual)},
          {"iterations", result.iterations},
          {"unknowns", result.unknowns},
          {"finest_cell_m", number(result.finest_cell_m)},
          {"sigma_m", number(result.sigma_m)},
          {"smoothing_length_m", number(result.smoothing_length_m)},
          {"triangles_before_decimation", result.decimation.triangles_before},
          {"decimation_bound_m",
           result.decimation.is_proven ? number(result.decimation.bound_m) : ordered_json(nullptr)},
          {"parts_per_axis", result.parts.parts_per_axis},
          {"seam_rms_m", result.parts.seam_rms_m},
          {"seam_largest_m", result.parts.seam_largest_m},
          {"sharp_edge_vertices", result.sharp.edge_vertices},
          {"sharp_corners", result.sharp.corners},
          {"area_m2", number(area_m2(result.surface))},
          {"unsupported_area_m2", number(unsupported_area_m2(result))},
          {"trimmed_area_m2", number(result.trimmed_area_m2)},
          {"stop", name_of(result.stop)},
          {"invalid_points", result.invalid_points},
          {"outlying_points", result.outlying_points},
          {"estimated_normals", result.estimated_normals},
          {"turned_normals", result.turned_normals},
          {"moved_points", result.moved_points}};
}

ordered_json measurement_json(const Measurement& m) {
  const auto ends = [](const std::optional<Interval>& interval) {
    return interval ? ordered_json{number(interval->low), number(interval->high)}
                    : ordered_json(nullptr);
  };
  const auto if_limited = [&](const ordered_json& value) {
    return m.limit ? value : ordered_json(nullptr);
  };
  return {{"name", m.name},
          {"value", number(m.value)},
          {"unit", m.unit},
          {"definition", definition(m.name)},
          {"over", m.over},
          {"count", m.count},
          {"limit", if_limited(number(m.limit.value_or(0)))},
          {"relation", if_limited(m.relation)},
          {"pass", m.pass},
          {"reason", if_limited(m.reason)},
          {"interval", ends(m.interval)},
          {"expected", ends(m.expected)}};
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
