// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/open3d_scene.h"

#ifdef LIBSCAN_WITH_OPEN3D
#include <open3d/geometry/PointCloud.h>
#include <open3d/geometry/TriangleMesh.h>
#include <open3d/t/geometry/RaycastingScene.h>
#endif

namespace scan {

#ifdef LIBSCAN_WITH_OPEN3D
namespace {

open3d::geometry::TriangleMesh open3d_mesh(const Mesh& mesh) {
  open3d::geometry::TriangleMesh copy;
  copy.vertices_.assign(mesh.vertices.begin(), mesh.vertices.end());
  for (const Triangle& t : mesh.triangles)
    copy.triangles_.emplace_back(static_cast<int>(t[0]), static_cast<int>(t[1]),
                                 static_cast<int>(t[2]));
  return copy;
}

}  // namespace

struct Open3dScene::Scene {
  mutable open3d::t::geometry::RaycastingScene scene;
};

std::optional<Open3dScene> Open3dScene::of(const Mesh& mesh) {
  auto scene = std::make_unique<Scene>();
  scene->scene.AddTriangles(open3d::t::geometry::TriangleMesh::FromLegacy(open3d_mesh(mesh)));
  return Open3dScene(std::move(scene));
}

std::vector<float> Open3dScene::distances_m(std::span<const Eigen::Vector3d> points) const {
  std::vector<float> flat;
  flat.reserve(3 * points.size());
  for (const Eigen::Vector3d& x : points)
    for (const double value : x) flat.push_back(static_cast<float>(value));
  const auto count = static_cast<std::int64_t>(points.size());
  return scene_->scene
      .ComputeDistance(open3d::core::Tensor(flat, {count, 3}, open3d::core::Dtype::Float32))
      .ToFlatVector<float>();
}

std::vector<Eigen::Vector3d> open3d_samples(const Mesh& mesh, std::size_t count) {
  return open3d_mesh(mesh).SamplePointsUniformly(count)->points_;
}
#else
struct Open3dScene::Scene {};

std::optional<Open3dScene> Open3dScene::of(const Mesh&) {
  return std::nullopt;
}

std::vector<float> Open3dScene::distances_m(std::span<const Eigen::Vector3d>) const {
  return {};
}

std::vector<Eigen::Vector3d> open3d_samples(const Mesh&, std::size_t) {
  return {};
}
#endif

Open3dScene::Open3dScene(std::unique_ptr<Scene> scene) : scene_(std::move(scene)) {}
Open3dScene::~Open3dScene() = default;
Open3dScene::Open3dScene(Open3dScene&&) noexcept = default;

}  // namespace scan
