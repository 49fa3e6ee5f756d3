// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan info: what a file holds.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/scan_file.h"
#include "tools/commands.h"
#include "tools/inputs.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

ordered_json three(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

std::string extent_text(const Bounds& box) {
  const Eigen::Vector3d size = box.sizes();
  return readable_length(size.x()) + " x " + readable_length(size.y()) + " x " +
         readable_length(size.z());
}

ordered_json bounds_json(const Bounds& box) {
  return {{"least_m", three(box.min())}, {"most_m", three(box.max())}};
}

ordered_json describe_mesh(const std::string& path, Console& console) {
  const Mesh mesh = read_mesh(path);
  const EdgeCensus census = edge_census(mesh);
  const Bounds box = bounds_of(mesh.vertices);
  console.say(path + ": mesh, " + std::to_string(mesh.vertices.size()) + " vertices, " +
              std::to_string(mesh.triangles.size()) + " triangles");
  console.say(
      "  extent " + extent_text(box) + "; " + std::to_string(census.components) + " components, " +
      (census.watertight ? "watertight, genus " + std::to_string(census.genus)
                         : std::to_string(census.boundary_edges) + " boundary edges, " +
                               std::to_string(census.non_manifold_edges) + " non-manifold"));
  const std::size_t flat = flat_triangles(mesh);
  if (flat > 0) console.say("  " + std::to_string(flat) + " triangles have no area");
  return {{"kind", "mesh"},
          {"vertices", mesh.vertices.size()},
          {"triangles", mesh.triangles.size()},
          {"triangles_without_area", flat},
          {"bounds", bounds_json(box)},
          {"area_m2", area_m2(mesh)},
          {"volume_m3", census.watertight ? ordered_json(volume_m3(mesh)) : ordered_json(nullptr)},
          {"components", census.components},
          {"boundary_edges", census.boundary_edges},
          {"non_manifold_edges", census.non_manifold_edges},
          {"watertight", census.watertight},
          {"genus", census.watertight ? ordered_json(census.genus) : ordered_json(nullptr)}};
}

ordered_json describe_cloud(const std::string& path, Console& console) {
  const Scan scan = read_scan(path);
  const Bounds box = bounds_of(scan.cloud.points);
  std::string parts;
  const auto part = [&](bool there, const char* name) {
    if (there) parts += (parts.empty() ? "" : ", ") + std::string(name);
  };
  part(!scan.cloud.normals.empty(), "normals");
  part(!scan.cloud.sigma_m.empty(), "sigma");
  part(!scan.cloud.covariances.empty(), "covariances");
  part(!scan.cloud.intensity.empty(), "intensity");
  part(!scan.ray.empty(), "rays");
  console.say(path + ": " + std::to_string(scan.cloud.size()) + " points" +
              (parts.empty() ? "" : " with " + parts));
  console.say("  extent " + extent_text(box));
  for (const auto& [reason, count] : scan.misses)
    console.say("  " + std::to_string(count) + " rays without a point: " + reason);
  return {{"kind", "points"},     {"points", scan.cloud.size()}, {"bounds", bounds_json(box)},
          {"has", parts},         {"rows", scan.grid.rows},      {"columns", scan.grid.columns},
          {"misses", scan.misses}};
}

}  // namespace

Action info_command(CommandLine& line) {
  auto path = std::make_shared<std::string>();
  line.input("FILE", *path, "a mesh, a cloud or a scan");
  return [path](Console& console) {
    if (std::filesystem::is_directory(*path))
      throw Error(Trouble::input, *path + ": is a folder, must be a file",
                  "scan verify measures a run folder");
    ordered_json result =
        holds_triangles(*path) ? describe_mesh(*path, console) : describe_cloud(*path, console);
    result["file"] = *path;
    console.finish("info", "ok", result);
    return 0;
  };
}

}  // namespace scan
