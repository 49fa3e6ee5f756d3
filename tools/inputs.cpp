// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/inputs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "libscan/core/error.h"
#include "libscan/core/median.h"
#include "libscan/io/scan_file.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

// Details and whole objects differ by less in size; the factors are those between inches,
// centimetres, millimetres, micrometres and the metre.
constexpr double least_suspect_ratio = 30;
constexpr std::array<double, 4> suspect_factors = {39.37, 100, 1000, 1e6};

double diagonal_m(const Bounds& box) {
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

// Says so if `size_m` is so far from the usual one that its unit may be another.
void warn_of_unit(const std::string& path, double size_m, double usual_m, const std::string& whose,
                  Console& console) {
  if (!(size_m > 0) || !(usual_m > 0)) return;
  const double off = std::abs(std::log10(size_m / usual_m));
  if (off < std::log10(least_suspect_ratio)) return;
  double factor = suspect_factors.front();
  for (const double other : suspect_factors)
    if (std::abs(std::log10(other) - off) < std::abs(std::log10(factor) - off)) factor = other;
  char scale[32];
  std::snprintf(scale, sizeof scale, "%.4g", size_m > usual_m ? 1 / factor : factor);
  console.warn(path + ": its size is " + readable_length(size_m) + ", that of " + whose + " is " +
               readable_length(usual_m) + "; another unit? Then scale it by " + scale);
}

}  // namespace

std::pair<std::vector<std::string>, std::string> split_output(std::vector<std::string> paths) {
  if (paths.size() < 2)
    throw Error(Trouble::usage, "needs at least one input and, last, the output");
  std::string output = std::move(paths.back());
  paths.pop_back();
  for (const std::string& path : paths)
    if (std::filesystem::weakly_canonical(path) == std::filesystem::weakly_canonical(output))
      throw Error(Trouble::usage, output + ": is an input, too; the last one is the output");
  return {std::move(paths), std::move(output)};
}

void check_output(const std::string& path) {
  if (std::filesystem::is_directory(path))
    throw Error(Trouble::output, path + ": is a folder, the output must be a file");
  const auto folder = std::filesystem::absolute(path).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw Error(Trouble::output, path + ": folder " + folder.string() + " does not exist");
}

void warn_of_lost_points(const std::string& path, const Scan& scan, Console& console) {
  if (const auto bad = scan.misses.find("not finite"); bad != scan.misses.end())
    console.warn(path + ": " + std::to_string(bad->second) + " points are not finite, left out");
}

std::size_t flat_triangles(const Mesh& mesh) {
  return static_cast<std::size_t>(
      std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                    [&](const Triangle& t) { return !(area_vector(mesh, t).norm() > 0); }));
}

void warn_of_flat_triangles(const std::string& path, const Mesh& mesh, Console& console) {
  const std::size_t flat = flat_triangles(mesh);
  if (flat == mesh.triangles.size())
    throw Error(Trouble::input, path + ": none of its triangles has an area");
  if (flat > 0)
    console.warn(path + ": " + std::to_string(flat) + " of " +
                 std::to_string(mesh.triangles.size()) + " triangles have no area");
}

std::vector<Scan> read_scans_with_normals(const std::vector<std::string>& paths, Console& console) {
  std::vector<Scan> scans;
  for (const std::string& path : paths) {
    scans.push_back(read_scan(path));
    Scan& scan = scans.back();
    warn_of_lost_points(path, scan, console);
    if (!scan.cloud.normals.empty()) continue;
    console.detail(path + ": has no normals; estimated from neighbouring points");
    estimate_normals(scan);
  }
  return scans;
}

void warn_of_units(const std::vector<std::string>& paths, const std::vector<Scan>& scans,
                   Console& console) {
  std::vector<double> sizes_m;
  for (const Scan& scan : scans) sizes_m.push_back(diagonal_m(bounds_of(scan.cloud.points)));
  const double usual_m = median(sizes_m);
  for (std::size_t i = 0; i < scans.size(); ++i)
    warn_of_unit(paths[i], sizes_m[i], usual_m, "most", console);
}

void warn_of_other_frame(const std::string& path, const Bounds& measured, const Bounds& truth,
                         Console& console) {
  if (measured.isEmpty() || truth.isEmpty() || !truth.sizes().allFinite()) return;
  warn_of_unit(path, diagonal_m(measured), diagonal_m(truth), "the truth", console);
  const double gap_m = std::sqrt(measured.squaredExteriorDistance(truth));
  if (gap_m > diagonal_m(truth))
    console.warn(path + ": lies " + readable_length(gap_m) + " from the truth, whose size is " +
                 readable_length(diagonal_m(truth)) + "; another frame? Then align it first");
}

void warn_of_holes(const std::string& path, const TrueSurface& truth, Console& console) {
  std::size_t edges = 0;
  for (const Mesh& mesh : truth.meshes) edges += edge_census(mesh).boundary_edges;
  if (edges == 0) return;
  console.warn(path + ": the true surface has holes (" + std::to_string(edges) +
               " boundary edges); no volume is compared, and distances go to their rims");
}

bool tell_of_pose(const std::string& scan, const ScanPose& pose, Console& console) {
  for (const std::string& direction : pose.weak_directions)
    console.warn(scan + ": the data leave it free to " + direction);
  if (pose.stop == Stop::iteration_limit)
    console.warn(scan + ": its pose still moved at the last round");
  return pose.stop == Stop::converged || pose.stop == Stop::degenerate ||
         pose.stop == Stop::iteration_limit;
}

PointCloud joined(const std::vector<Scan>& scans, const std::vector<Pose>& world_from_scan) {
  PointCloud all = transformed(world_from_scan.front(), scans.front().cloud);
  for (std::size_t i = 1; i < scans.size(); ++i)
    append(all, transformed(world_from_scan[i], scans[i].cloud));
  return all;
}

std::vector<Eigen::Vector3d> joined_viewpoints(const std::vector<Scan>& scans,
                                               const std::vector<Pose>& world_from_scan) {
  std::vector<Eigen::Vector3d> all;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (scans[i].ray.size() != scans[i].cloud.size()) return {};
    all.insert(all.end(), scans[i].cloud.size(), world_from_scan[i] * scans[i].viewpoint);
  }
  return all;
}

}  // namespace scan
