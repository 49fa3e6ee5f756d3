// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/scan_ply.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "libscan/core/error.h"
#include "libscan/io/poses.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

constexpr std::uint32_t no_ray = std::numeric_limits<std::uint32_t>::max();
const Eigen::Vector3d stanford_viewpoint_m(0, 0, 100);

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw Error(Trouble::input, path.string() + ": " + what);
}

std::string guess_comment(const Pose& pose) {
  std::string text = "libscan world_from_scanner_guess";
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) text += " " + shortest(pose(row, column));
  return text;
}

Pose parse_guess(std::string_view words, const std::filesystem::path& path) {
  const std::string key = "comment 'libscan world_from_scanner_guess'";
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const auto number = number_from<double>(take_word(words));
      if (!number) fail(path, key + " must hold 16 numbers");
      matrix(row, column) = *number;
    }
  return pose_from_matrix(matrix, path.string() + ": " + key);
}

GuessSigma parse_guess_sigma(std::string_view words, const std::filesystem::path& path) {
  GuessSigma sigma;
  for (double* value : {&sigma.rotation_rad, &sigma.translation_m}) {
    const auto number = number_from<double>(take_word(words));
    if (!number || !std::isfinite(*number) || *number < 0)
      fail(path, "comment 'libscan guess_sigma' must hold 2 finite numbers, none negative");
    *value = *number;
  }
  return sigma;
}

std::string viewpoint_comment(const Eigen::Vector3d& viewpoint) {
  std::string text = "libscan viewpoint";
  for (const double x : viewpoint) text += " " + shortest(x);
  return text;
}

Eigen::Vector3d parse_viewpoint(std::string_view words, const std::filesystem::path& path) {
  Eigen::Vector3d viewpoint;
  for (double& x : viewpoint) {
    const auto number = number_from<double>(take_word(words));
    if (!number || !std::isfinite(*number))
      fail(path, "comment 'libscan viewpoint' must hold 3 finite numbers");
    x = *number;
  }
  return viewpoint;
}

template <class Number>
Number parse_whole(std::string_view& words, const std::filesystem::path& path) {
  const std::string word(take_word(words));
  const auto number = number_from<Number>(word);
  if (!number) fail(path, "comment 'libscan ...': '" + word + "' is no count");
  return *number;
}

// Rows and columns, positive.
RayGrid parse_window(std::string_view words, const std::filesystem::path& path) {
  RayGrid window;
  window.rows = parse_whole<std::uint32_t>(words, path);
  window.columns = parse_whole<std::uint32_t>(words, path);
  if (window.rows == 0 || window.columns == 0)
    fail(path, "comment 'libscan noise_window' must hold 2 positive numbers");
  return window;
}

void parse_comment(std::string_view words, Scan& scan, const std::filesystem::path& path) {
  if (take_word(words) != "libscan") return;
  const std::string_view key = take_word(words);
  if (key == "grid") {
    scan.grid.rows = parse_whole<std::uint32_t>(words, path);
    scan.grid.columns = parse_whole<std::uint32_t>(words, path);
  } else if (key == "noise_window") {
    scan.noise_window = parse_window(words, path);
  } else if (key == "miss") {
    const auto count = parse_whole<std::size_t>(words, path);
    scan.misses[std::string(words.substr(std::min<std::size_t>(1, words.size())))] += count;
  } else if (key == "viewpoint") {
    scan.viewpoint = parse_viewpoint(words, path);
  } else if (key == "world_from_scanner_guess") {
    scan.world_from_scanner_guess = parse_guess(words, path);
  } else if (key == "guess_sigma") {
    scan.guess_sigma = parse_guess_sigma(words, path);
  }
}

void parse_rays(const PlyElement& vertex, Scan& scan, const std::filesystem::path& path) {
  const double limit = static_cast<double>(scan.grid.rows) * scan.grid.columns;
  for (const double ray : vertex.numbers("ray")) {
    if (!(ray >= 0) || ray != std::floor(ray) || ray >= no_ray || (limit > 0 && ray >= limit))
      fail(path, "element 'vertex', property 'ray', row " + std::to_string(scan.ray.size()) + ": " +
                     shortest(ray) + " is no ray of the scan");
    scan.ray.push_back(static_cast<std::uint32_t>(ray));
  }
}

std::optional<std::uint32_t> info_number(const Ply& ply, std::string_view key) {
  for (std::string_view line : ply.obj_info)
    if (take_word(line) == key) return number_from<std::uint32_t>(take_word(line));
  return std::nullopt;
}

// The ray of each vertex by the lists of a range grid; no_ray where none names it.
std::vector<std::uint32_t> rays_of(const PlyProperty& cells, std::size_t vertices,
                                   const std::filesystem::path& path) {
  std::vector<std::uint32_t> rays(vertices, no_ray);
  std::size_t next = 0;
  const auto vertex_at = [&](std::size_t i) {
    return std::visit([&](const auto& values) { return static_cast<double>(values[i]); },
                      cells.values);
  };
  for (std::size_t cell = 0; cell < cells.lengths.size(); ++cell) {
    if (cells.lengths[cell] == 0) continue;
    const std::string place = "element 'range_grid', row " + std::to_string(cell) + ": ";
    if (cells.lengths[cell] > 1) fail(path, place + "names more than one vertex");
    const double vertex = vertex_at(next++);
    if (!(vertex >= 0) || vertex != std::floor(vertex) || vertex >= static_cast<double>(vertices))
      fail(path, place + "vertex " + shortest(vertex) + ", there are " + std::to_string(vertices));
    std::uint32_t& ray = rays[static_cast<std::size_t>(vertex)];
    if (ray != no_ray) fail(path, place + "vertex " + shortest(vertex) + " is named twice");
    ray = static_cast<std::uint32_t>(cell);
  }
  return rays;
}

void parse_range_grid(const Ply& ply, const PlyElement& element, Scan& scan,
                      const std::filesystem::path& path) {
  const PlyProperty* cells = element.find("vertex_indices");
  if (!cells || !cells->is_list) fail(path, "element 'range_grid' has no list 'vertex_indices'");
  if (element.count >= no_ray) fail(path, "element 'range_grid' has too many rows");
  const auto rows = info_number(ply, "num_rows"), columns = info_number(ply, "num_cols");
  if (rows && columns) {
    if (static_cast<std::uint64_t>(*rows) * *columns != element.count)
      fail(path, "element 'range_grid' has " + std::to_string(element.count) +
                     " rows, obj_info says " + std::to_string(*rows) + " x " +
                     std::to_string(*columns));
    scan.grid = {*rows, *columns};
  }
  scan.viewpoint = stanford_viewpoint_m;
  auto rays = rays_of(*cells, scan.cloud.size(), path);
  const auto empty = std::count(cells->lengths.begin(), cells->lengths.end(), 0u);
  if (empty > 0) scan.misses["not recorded"] = static_cast<std::size_t>(empty);
  const bool is_complete = std::find(rays.begin(), rays.end(), no_ray) == rays.end();
  if (is_complete) scan.ray = std::move(rays);
}

}  // namespace

Ply ply_from(const Scan& scan) {
  Ply ply = ply_from(scan.cloud);
  if (!scan.ray.empty()) {
    if (scan.ray.size() != scan.cloud.size())
      throw Error(Trouble::input, "scan " + scan.name + ": " + std::to_string(scan.ray.size()) +
                                      " ray indices for " + std::to_string(scan.cloud.size()) +
                                      " points");
    ply.elements.front().properties.push_back({"ray", scan.ray, {}, false});
  }
  if (scan.grid.rows > 0 || scan.grid.columns > 0)
    ply.comments.push_back("libscan grid " + std::to_string(scan.grid.rows) + " " +
                           std::to_string(scan.grid.columns));
  if (scan.noise_window.rows != 1 || scan.noise_window.columns != 1)
    ply.comments.push_back("libscan noise_window " + std::to_string(scan.noise_window.rows) + " " +
                           std::to_string(scan.noise_window.columns));
  for (const auto& [reason, count] : scan.misses)
    ply.comments.push_back("libscan miss " + std::to_string(count) + " " + reason);
  ply.comments.push_back(viewpoint_comment(scan.viewpoint));
  ply.comments.push_back(guess_comment(scan.world_from_scanner_guess));
  if (scan.guess_sigma)
    ply.comments.push_back("libscan guess_sigma " + shortest(scan.guess_sigma->rotation_rad) + " " +
                           shortest(scan.guess_sigma->translation_m));
  return ply;
}

Scan scan_from(const Ply& ply, const std::filesystem::path& path) {
  Scan scan;
  scan.cloud = cloud_from(ply, path);
  for (const std::string& comment : ply.comments) parse_comment(comment, scan, path);
  if (const PlyElement* range_grid = ply.find("range_grid"))
    parse_range_grid(ply, *range_grid, scan, path);
  else
    parse_rays(*ply.find("vertex"), scan, path);
  return scan;
}

}  // namespace scan
