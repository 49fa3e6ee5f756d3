// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/scene_data.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tools/report/colour_map.h"
#include "tools/report/picture.h"
#include "tools/report/point_pack.h"
#include "tools/run_files.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

constexpr double surface_share = 0.6;
constexpr double kept_share = 0.05;  // of the surface's points, for the worst deviations
constexpr int colour_steps = 65;

ordered_json numbers(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

template <class T>
std::vector<T> chosen(const std::vector<T>& all, std::span<const std::uint32_t> indices) {
  std::vector<T> some;
  if (all.empty()) return some;
  for (const std::uint32_t i : indices) some.push_back(all[i]);
  return some;
}

ordered_json surface_json(const RunRecord& record, std::size_t most) {
  if (record.surface.vertices.empty()) return nullptr;
  const auto picked = thinned(record.surface.vertices.size(), record.deviations_m, most,
                              static_cast<std::size_t>(kept_share * static_cast<double>(most)));
  return packed_points({.points = chosen(record.surface.vertices, picked),
                        .normals = chosen(vertex_normals(record.surface), picked),
                        .deviations_m = chosen(record.deviations_m, picked),
                        .support_m = chosen(record.support_m, picked)});
}

ordered_json scan_json(const Scan& scan, std::size_t most) {
  const auto finite = finite_points(scan.cloud);
  const PointCloud cloud = subset(scan.cloud, finite);
  const auto picked = thinned(cloud.size(), {}, most, 0);
  Eigen::Vector3d aim = Eigen::Vector3d::Zero();
  double reach_m = 0;
  for (const Eigen::Vector3d& point : cloud.points) {
    aim += (point - scan.viewpoint).normalized();
    reach_m += (point - scan.viewpoint).norm() / static_cast<double>(cloud.size());
  }
  return {{"name", scan.name},
          {"points", packed_points({.points = chosen(cloud.points, picked),
                                    .normals = chosen(cloud.normals, picked)})},
          {"viewpoint_m", numbers(scan.viewpoint)},
          {"reach_m", reach_m},
          {"aim", numbers(aim.norm() > 0 ? Eigen::Vector3d(aim.normalized())
                                         : Eigen::Vector3d(Eigen::Vector3d::UnitZ()))}};
}

Eigen::Vector3d middle(const PointCloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : cloud.points) sum += point;
  return cloud.empty() ? sum : Eigen::Vector3d(sum / static_cast<double>(cloud.size()));
}

// With the eight digits that a picture needs.
double shortened(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.8g", value);
  return std::strtod(text, nullptr);
}

double off_m(const PoseStep& step, const RunRecord& record,
             const std::vector<Eigen::Vector3d>& middles) {
  double sum = 0;
  for (std::size_t i = 0; i < middles.size(); ++i)
    sum += (step.world_from_scan[i] * middles[i] - record.world_from_scan[i] * middles[i]).norm();
  return sum / static_cast<double>(std::max<std::size_t>(1, middles.size()));
}

ordered_json steps_json(const RunRecord& record) {
  std::vector<PoseStep> steps = record.steps;
  if (!record.world_from_scan.empty()) steps.push_back({"result", record.world_from_scan});
  std::vector<Eigen::Vector3d> middles;
  for (const Scan& scan : record.scans)
    middles.push_back(middle(subset(scan.cloud, finite_points(scan.cloud))));
  ordered_json traced = trace_json(steps);
  for (auto& step : traced.at("steps"))
    for (auto& pose : step.at("world_from_scan"))
      for (auto& number : pose) number = shortened(number.get<double>());
  ordered_json list = ordered_json::array();
  for (std::size_t k = 0; k < steps.size(); ++k)
    list.push_back({{"step", steps[k].step},
                    {"poses", traced.at("steps")[k].at("world_from_scan")},
                    {"off_m", off_m(steps[k], record, middles)}});
  return list;
}

ordered_json colours_json() {
  ordered_json list = ordered_json::array();
  for (int i = 0; i < colour_steps; ++i) {
    const Colour c = diverging_colour(2.0 * i / (colour_steps - 1) - 1);
    list.push_back({c[0], c[1], c[2]});
  }
  return list;
}

// Around the surface, or else around the scans as they come to lie.
Bounds box_of(const RunRecord& record) {
  if (!record.surface.vertices.empty()) return bounds_of(record.surface.vertices);
  Bounds box;
  for (std::size_t i = 0; i < record.world_from_scan.size(); ++i)
    box.extend(bounds_of(transformed(record.world_from_scan[i], record.scans[i].cloud).points));
  return box;
}

ordered_json call_outs_json(const RunRecord& record, const ordered_json& twin) {
  if (twin.at("deviation").is_null()) return ordered_json::array();
  ordered_json list = twin.at("deviation").at("call_outs");
  const auto normals = vertex_normals(record.surface);
  const auto& vertices = record.surface.vertices;
  for (auto& place : list) {
    const auto at = place.at("position_m").get<std::array<double, 3>>();
    const auto vertex = std::find(vertices.begin(), vertices.end(), Eigen::Vector3d(at.data()));
    place["normal"] = numbers(normals[static_cast<std::size_t>(vertex - vertices.begin())]);
  }
  return list;
}

}  // namespace

ordered_json scene_data(const RunRecord& record, const ordered_json& twin,
                        std::size_t most_points) {
  const bool posed = !record.world_from_scan.empty() && !record.scans.empty();
  const auto of_surface =
      static_cast<std::size_t>((posed ? surface_share : 1) * static_cast<double>(most_points));
  ordered_json scans = ordered_json::array();
  if (posed)
    for (const Scan& scan : record.scans)
      scans.push_back(scan_json(scan, (most_points - of_surface) / record.scans.size()));
  const Bounds box = box_of(record);
  const ordered_json& deviation = twin.at("deviation");
  return {
      {"surface", surface_json(record, of_surface)},
      {"scans", scans},
      {"steps", posed ? steps_json(record) : ordered_json::array()},
      {"limit_m", deviation.is_null() ? ordered_json() : deviation.at("histogram").at("limit_m")},
      {"colours", colours_json()},
      {"box", {numbers(box.min()), numbers(box.max())}},
      {"call_outs", call_outs_json(record, twin)}};
}

}  // namespace scan
