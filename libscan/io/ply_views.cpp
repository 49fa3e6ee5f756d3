// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// PLY's well-known elements as clouds and meshes.
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "libscan/core/error.h"
#include "libscan/io/ply.h"

namespace scan {
namespace {

constexpr std::array<const char*, 3> position_names = {"x", "y", "z"};
constexpr std::array<const char*, 3> normal_names = {"nx", "ny", "nz"};
constexpr std::array<const char*, 6> covariance_names = {"cov_xx", "cov_xy", "cov_xz",
                                                         "cov_yy", "cov_yz", "cov_zz"};
constexpr std::array<std::array<int, 2>, 6> covariance_places = {
    {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};

// The columns of the given names; empty if one of them is missing.
template <std::size_t N>
std::vector<std::array<double, N>> rows_of(const PlyElement& element,
                                           const std::array<const char*, N>& names) {
  std::array<std::vector<double>, N> columns;
  for (std::size_t i = 0; i < N; ++i) {
    columns[i] = element.numbers(names[i]);
    if (columns[i].size() != element.count) return {};
  }
  std::vector<std::array<double, N>> rows(element.count);
  for (std::size_t row = 0; row < element.count; ++row)
    for (std::size_t i = 0; i < N; ++i) rows[row][i] = columns[i][row];
  return rows;
}

std::vector<Eigen::Vector3d> vectors_of(const PlyElement& element,
                                        const std::array<const char*, 3>& names) {
  std::vector<Eigen::Vector3d> vectors;
  vectors.reserve(element.count);
  for (const auto& row : rows_of(element, names)) vectors.emplace_back(row[0], row[1], row[2]);
  return vectors;
}

const PlyElement& vertices_of(const Ply& ply, const std::filesystem::path& path) {
  const PlyElement* vertex = ply.find("vertex");
  if (!vertex) throw Error(Trouble::input, path.string() + ": has no element 'vertex'");
  for (const char* name : position_names) {
    const PlyProperty* property = vertex->find(name);
    if (!property || property->is_list)
      throw Error(Trouble::input,
                  path.string() + ": element 'vertex' has no property '" + name + "'");
  }
  return *vertex;
}

std::vector<double> intensity_of(const PlyElement& vertex) {
  for (const char* name : {"intensity", "scalar_intensity", "scalar_Intensity"})
    if (auto values = vertex.numbers(name); !values.empty()) return values;
  return {};
}

std::vector<Eigen::Matrix3d> covariances_of(const PlyElement& vertex) {
  std::vector<Eigen::Matrix3d> matrices;
  for (const auto& row : rows_of(vertex, covariance_names)) {
    Eigen::Matrix3d& matrix = matrices.emplace_back();
    for (std::size_t i = 0; i < 6; ++i) {
      const auto [a, b] = covariance_places[i];
      matrix(a, b) = matrix(b, a) = row[i];
    }
  }
  return matrices;
}

void add_column(PlyElement& element, const char* name, std::vector<double> values) {
  element.properties.push_back({name, std::move(values), {}, false});
}

void add_vectors(PlyElement& element, const std::array<const char*, 3>& names,
                 const std::vector<Eigen::Vector3d>& vectors) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> column(vectors.size());
    for (std::size_t i = 0; i < vectors.size(); ++i) column[i] = vectors[i][axis];
    add_column(element, names[static_cast<std::size_t>(axis)], std::move(column));
  }
}

std::vector<std::uint32_t> corner_indices(const PlyElement& face, const PlyProperty& corners,
                                          std::size_t vertices, const std::filesystem::path& path) {
  std::vector<std::uint32_t> indices;
  const auto take = [&]<class Number>(const std::vector<Number>& values) {
    indices.reserve(values.size());
    for (const Number value : values) {
      if (!(value >= 0) || static_cast<double>(value) >= static_cast<double>(vertices) ||
          static_cast<Number>(static_cast<std::uint32_t>(value)) != value)
        throw Error(Trouble::input, path.string() + ": element '" + face.name + "', property '" +
                                        corners.name + "': vertex " + std::to_string(value) +
                                        ", there are " + std::to_string(vertices));
      indices.push_back(static_cast<std::uint32_t>(value));
    }
  };
  std::visit(take, corners.values);
  return indices;
}

}  // namespace

const PlyProperty* PlyElement::find(std::string_view property) const {
  const auto found = std::find_if(properties.begin(), properties.end(),
                                  [&](const PlyProperty& p) { return p.name == property; });
  return found == properties.end() ? nullptr : &*found;
}

std::vector<double> PlyElement::numbers(std::string_view property) const {
  const PlyProperty* found = find(property);
  if (!found || found->is_list) return {};
  return std::visit(
      [](const auto& values) { return std::vector<double>(values.begin(), values.end()); },
      found->values);
}

const PlyElement* Ply::find(std::string_view element) const {
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const PlyElement& e) { return e.name == element; });
  return found == elements.end() ? nullptr : &*found;
}

PointCloud cloud_from(const Ply& ply, const std::filesystem::path& path) {
  const PlyElement& vertex = vertices_of(ply, path);
  PointCloud cloud;
  cloud.points = vectors_of(vertex, position_names);
  cloud.normals = vectors_of(vertex, normal_names);
  cloud.sigma_m = vertex.numbers("sigma_m");
  cloud.covariances = covariances_of(vertex);
  cloud.intensity = intensity_of(vertex);
  return cloud;
}

Mesh mesh_from(const Ply& ply, const std::filesystem::path& path) {
  Mesh mesh;
  mesh.vertices = vectors_of(vertices_of(ply, path), position_names);
  const PlyElement* face = ply.find("face");
  if (!face) return mesh;
  const PlyProperty* corners = face->find("vertex_indices");
  if (!corners) corners = face->find("vertex_index");
  if (!corners || !corners->is_list)
    throw Error(Trouble::input, path.string() + ": element 'face' has no list 'vertex_indices'");
  const auto indices = corner_indices(*face, *corners, mesh.vertices.size(), path);
  std::size_t first = 0;
  for (const std::uint32_t corner_count : corners->lengths) {
    for (std::uint32_t k = 2; k < corner_count; ++k)
      mesh.triangles.push_back({indices[first], indices[first + k - 1], indices[first + k]});
    first += corner_count;
  }
  return mesh;
}

Ply ply_from(const PointCloud& cloud) {
  check(cloud);
  PlyElement vertex{"vertex", cloud.size(), {}};
  add_vectors(vertex, position_names, cloud.points);
  if (!cloud.normals.empty()) add_vectors(vertex, normal_names, cloud.normals);
  if (!cloud.sigma_m.empty()) add_column(vertex, "sigma_m", cloud.sigma_m);
  for (std::size_t i = 0; i < 6 && !cloud.covariances.empty(); ++i) {
    std::vector<double> column;
    const auto [a, b] = covariance_places[i];
    for (const Eigen::Matrix3d& matrix : cloud.covariances) column.push_back(matrix(a, b));
    add_column(vertex, covariance_names[i], std::move(column));
  }
  if (!cloud.intensity.empty()) add_column(vertex, "intensity", cloud.intensity);
  return {{}, {}, {std::move(vertex)}};
}

Ply ply_from(const Mesh& mesh) {
  PlyElement vertex{"vertex", mesh.vertices.size(), {}};
  add_vectors(vertex, position_names, mesh.vertices);
  std::vector<std::int32_t> corners;
  corners.reserve(3 * mesh.triangles.size());
  std::vector<std::uint32_t> sizes;
  for_each_polygon(mesh, [&](std::span<const std::uint32_t> polygon) {
    for (const std::uint32_t corner : polygon) {
      if (corner >= mesh.vertices.size() || !std::in_range<std::int32_t>(corner))
        throw Error(Trouble::input, "mesh: a triangle names vertex " + std::to_string(corner) +
                                        " of " + std::to_string(mesh.vertices.size()));
      corners.push_back(static_cast<std::int32_t>(corner));
    }
    sizes.push_back(static_cast<std::uint32_t>(polygon.size()));
  });
  PlyElement face{"face", sizes.size(), {}};
  face.properties.push_back({"vertex_indices", std::move(corners), std::move(sizes), true});
  return {{}, {}, {std::move(vertex), std::move(face)}};
}

}  // namespace scan
