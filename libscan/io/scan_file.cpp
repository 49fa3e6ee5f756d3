// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/scan_file.h"

#include <cmath>
#include <optional>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/image_file.h"
#include "libscan/io/mesh_import.h"
#include "libscan/io/mesh_text.h"
#include "libscan/io/pcd.h"
#include "libscan/io/ply.h"
#include "libscan/io/ply_header.h"
#include "libscan/io/scan_ply.h"
#include "libscan/io/text.h"
#include "libscan/io/xyz.h"

namespace scan {
namespace {

std::string ending_of(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

[[noreturn]] void refuse_ending(const std::filesystem::path& path, Trouble trouble,
                                const std::string& known) {
  throw Error(trouble, path.string() + ": format '" + path.extension().string() +
                           "' is not one of " + known);
}

[[noreturn]] void refuse_scan_ending(const std::filesystem::path& path) {
  refuse_ending(path, Trouble::output, ".ply .pcd .xyz .txt .asc");
}

[[noreturn]] void refuse_mesh_ending(const std::filesystem::path& path) {
  refuse_ending(path, Trouble::output, ".ply .obj .stl .off");
}

PointCloud cloud_from_array(const std::filesystem::path& path) {
  const NumberArray array = read_npy(path);
  if (array.shape.size() != 2)
    throw Error(Trouble::input, path.string() +
                                    ": points need an array of two dimensions, it has " +
                                    std::to_string(array.shape.size()));
  return cloud_from_rows(array.values, array.shape[1], path.string());
}

Scan read_any_scan(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  if (ending == ".ply") return scan_from(read_ply(path), path);
  Scan scan;
  if (ending == ".pcd")
    scan.cloud = read_pcd(path);
  else if (ending == ".xyz" || ending == ".txt" || ending == ".asc")
    scan.cloud = read_xyz(path);
  else if (ending == ".npy" || ending == ".npz")
    scan.cloud = cloud_from_array(path);
  else
    refuse_ending(path, Trouble::input, ".ply .pcd .xyz .txt .asc .npy .npz");
  return scan;
}

// Normals become unit, or (0, 0, 0) where they say nothing. Those that are unit to 1e-6 stay as
// they are: a file's floats are that good, and what libscan wrote must come back to the bit.
void tidy_normals(PointCloud& cloud) {
  for (Eigen::Vector3d& normal : cloud.normals) {
    const double length = normal.stableNorm();
    if (!std::isfinite(length) || length == 0)
      normal.setZero();
    else if (std::abs(length - 1) > 1e-6)
      normal /= length;
  }
}

void drop_points_not_finite(Scan& scan) {
  const auto kept = finite_points(scan.cloud);
  const std::size_t dropped = scan.cloud.size() - kept.size();
  if (dropped == 0) return;
  scan.cloud = subset(scan.cloud, kept);
  if (!scan.ray.empty()) {
    std::vector<std::uint32_t> rays;
    rays.reserve(kept.size());
    for (const std::uint32_t i : kept) rays.push_back(scan.ray[i]);
    scan.ray = std::move(rays);
  }
  scan.misses["not finite"] += dropped;
}

void check_uncertainty(const PointCloud& cloud, const std::filesystem::path& path) {
  for (std::size_t i = 0; i < cloud.sigma_m.size(); ++i)
    if (!std::isfinite(cloud.sigma_m[i]) || cloud.sigma_m[i] < 0)
      throw Error(Trouble::input, path.string() + ": point " + std::to_string(i) + ": sigma_m is " +
                                      shortest(cloud.sigma_m[i]) + ", must not be negative");
  for (std::size_t i = 0; i < cloud.covariances.size(); ++i)
    if (!cloud.covariances[i].allFinite())
      throw Error(Trouble::input,
                  path.string() + ": point " + std::to_string(i) + ": covariance is not finite");
}

TexturedMesh read_any_mesh(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  if (ending == ".ply") return {mesh_from(read_ply(path), path), {}};
  if (ending == ".obj") return parse_obj(read_file(path), path.string());
  if (ending == ".off") return {parse_off(read_file(path), path.string()), {}};
  if (ending == ".stl") return {parse_stl(read_file(path), path.string()), {}};
  if (ending == ".glb" || ending == ".gltf") return read_gltf(path);
  refuse_ending(path, Trouble::input, ".ply .obj .stl .off .glb .gltf");
}

Ply ply_without_values(const std::filesystem::path& path) {
  return parse_ply_header(read_file(path), path.string()).empty;
}

std::optional<std::size_t> face_count(const Ply& ply) {  // none if it does not speak of faces
  const PlyElement* face = ply.find("face");
  return face ? std::optional<std::size_t>(face->count) : std::nullopt;
}

}  // namespace

Scan read_scan(const std::filesystem::path& path) {
  Scan scan = read_any_scan(path);
  scan.name = path.stem().string();
  tidy_normals(scan.cloud);
  drop_points_not_finite(scan);
  check_uncertainty(scan.cloud, path);
  if (scan.cloud.empty()) throw Error(Trouble::input, path.string() + ": holds no valid point");
  return scan;
}

void write_scan(const std::filesystem::path& path, const Scan& scan) {
  const std::string ending = ending_of(path);
  if (ending == ".ply")
    write_ply(path, ply_from(scan));
  else if (ending == ".pcd")
    write_pcd(path, scan.cloud);
  else if (ending == ".xyz" || ending == ".txt" || ending == ".asc")
    write_xyz(path, scan.cloud);
  else
    refuse_scan_ending(path);
}

void check_scan_ending(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  for (const char* known : {".ply", ".pcd", ".xyz", ".txt", ".asc"})
    if (ending == known) return;
  refuse_scan_ending(path);
}

void check_mesh_ending(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  for (const char* known : {".ply", ".obj", ".stl", ".off"})
    if (ending == known) return;
  refuse_mesh_ending(path);
}

TexturedMesh read_textured_mesh(const std::filesystem::path& path) {
  TexturedMesh textured = read_any_mesh(path);
  if (textured.mesh.empty()) throw Error(Trouble::input, path.string() + ": holds no triangle");
  try {
    check(textured.mesh);
  } catch (const Error& error) {
    throw Error(error.trouble(), path.string() + ": " + error.what());
  }
  return textured;
}

Mesh read_mesh(const std::filesystem::path& path) {
  return read_textured_mesh(path).mesh;
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh) {
  const std::string ending = ending_of(path);
  if (ending == ".ply")
    write_ply(path, ply_from(mesh));
  else if (ending == ".obj")
    write_file(path, obj_text(mesh));
  else if (ending == ".off")
    write_file(path, off_text(mesh));
  else if (ending == ".stl")
    write_file(path, stl_bytes(mesh));
  else
    refuse_mesh_ending(path);
}

bool holds_triangles(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  if (ending == ".ply") return face_count(ply_without_values(path)).value_or(0) > 0;
  return ending == ".obj" || ending == ".off" || ending == ".stl" || ending == ".glb" ||
         ending == ".gltf";
}

bool lists_no_face(const std::filesystem::path& path) {
  return ending_of(path) == ".ply" && face_count(ply_without_values(path)) == 0u;
}

bool is_emptied_surface(const std::filesystem::path& path) {
  if (ending_of(path) != ".ply") return false;
  const Ply ply = ply_without_values(path);
  if (face_count(ply) != 0u) return false;
  const PlyElement* vertex = ply.find("vertex");
  return !vertex || vertex->count == 0 || vertex->find("support_m");
}

}  // namespace scan
