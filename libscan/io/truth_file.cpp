// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/truth_file.h"

#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_reader.h"
#include "libscan/io/ply.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"
#include "libscan/io/shape_json.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

void write_surface(const std::filesystem::path& folder, const TrueSurface& surface) {
  ordered_json shapes = ordered_json::array(), meshes = ordered_json::array();
  for (const PlacedShape& placed : surface.shapes) shapes.push_back(to_json(placed));
  for (std::size_t i = 0; i < surface.meshes.size(); ++i) {
    const std::string name = "surface_" + numbered(i, ".ply");
    write_mesh(folder / name, surface.meshes[i]);
    meshes.push_back(name);
  }
  const ordered_json document = {{"shapes", shapes}, {"meshes", meshes}};
  write_file(folder / "surface.json", document.dump(1) + "\n");
}

TrueSurface read_surface_json(const std::filesystem::path& path) {
  const nlohmann::json document = read_json(path);
  JsonReader reader(document, path.string());
  TrueSurface surface;
  if (reader.has("shapes"))
    for (JsonReader& entry : reader.objects("shapes"))
      surface.shapes.push_back(read_placed_shape(entry));
  if (reader.has("meshes")) {
    const nlohmann::json& names = reader.value("meshes");
    if (!names.is_array()) reader.fail("meshes", "must be a list of file names");
    for (const nlohmann::json& name : names) {
      if (!name.is_string()) reader.fail("meshes", "must hold file names only, has " + name.dump());
      surface.meshes.push_back(read_mesh(path.parent_path() / name.get<std::string>()));
    }
  }
  reader.finish();
  return surface;
}

Ply ply_from(const std::vector<RayTruth>& rays) {
  PointCloud cloud;
  std::vector<std::int32_t> objects;
  for (const RayTruth& ray : rays) {
    cloud.points.push_back(ray.point_in_scanner);
    cloud.normals.push_back(ray.normal_in_scanner);
    objects.push_back(ray.object);
  }
  Ply ply = scan::ply_from(cloud);
  ply.elements.front().properties.push_back({"object", std::move(objects), {}, false});
  return ply;
}

std::vector<RayTruth> read_rays(const std::filesystem::path& path) {
  const Ply ply = read_ply(path);
  const PointCloud cloud = cloud_from(ply, path);
  const PlyProperty* object = ply.find("vertex")->find("object");
  const auto* objects = object ? std::get_if<std::vector<std::int32_t>>(&object->values) : nullptr;
  if (!objects || object->is_list || cloud.normals.size() != cloud.size())
    throw Error(Trouble::input,
                path.string() + ": is no truth of rays (x y z nx ny nz, int object)");
  std::vector<RayTruth> rays;
  rays.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    rays.push_back({cloud.points[i], cloud.normals[i], (*objects)[i]});
  return rays;
}

}  // namespace

void write_true_rays(const std::filesystem::path& folder, std::size_t scan,
                     const std::vector<RayTruth>& rays) {
  write_ply(folder / numbered(scan, ".ply"), ply_from(rays));
}

void write_true_scene(const std::filesystem::path& folder, const TrueSurface& surface,
                      const std::vector<Pose>& world_from_scanner) {
  std::vector<NamedPose> poses;
  for (const Pose& pose : world_from_scanner) poses.push_back({std::to_string(poses.size()), pose});
  write_poses_tum(folder / "poses.tum", poses);
  write_surface(folder, surface);
}

Truth read_truth(const std::filesystem::path& folder) {
  Truth truth;
  truth.surface = read_true_surface(folder / "surface.json");
  for (const NamedPose& named : read_poses(folder / "poses.tum")) {
    const std::size_t i = truth.scans.size();
    truth.scans.push_back({numbered(i, ""), named.pose, read_rays(folder / numbered(i, ".ply"))});
  }
  return truth;
}

TrueSurface read_true_surface(const std::filesystem::path& path) {
  if (lower_case(path.extension().string()) != ".json") return {{}, {read_mesh(path)}};
  TrueSurface surface = read_surface_json(path);
  if (surface.shapes.empty() && surface.meshes.empty())
    throw Error(Trouble::input, path.string() + ": holds neither shapes nor meshes");
  return surface;
}

}  // namespace scan
