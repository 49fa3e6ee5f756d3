// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Open3D's ray-casting scene, asked for distances to a mesh. Single precision, as all of it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "libscan/core/mesh.h"

namespace scan {

class Open3dScene {
 public:
  // None in a build without Open3D.
  static std::optional<Open3dScene> of(const Mesh& mesh);
  ~Open3dScene();
  Open3dScene(Open3dScene&&) noexcept;

  // On all threads that Open3D takes.
  std::vector<float> distances_m(std::span<const Eigen::Vector3d> points) const;

 private:
  struct Scene;
  explicit Open3dScene(std::unique_ptr<Scene> scene);
  std::unique_ptr<Scene> scene_;
};

// `count` points that Open3D draws uniformly on a mesh; none in a build without it.
std::vector<Eigen::Vector3d> open3d_samples(const Mesh& mesh, std::size_t count);

}  // namespace scan
