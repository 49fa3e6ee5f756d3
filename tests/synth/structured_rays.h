// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Rays from inside a closed mesh, aimed exactly at its vertices and at points of its edges: all of
// them hit it there or before, wherever they start.
#pragma once

#include "libscan/core/parallel.h"
#include "synth/ray_caster.h"
#include "tests/synth/ray_scenes.h"

namespace scan::synth {

// How many of rays [begin, end) pass their target; the mesh lies in the world as it is, its inside
// holds the ball of radius 0.5 around `centre`. Each block of rays leaves one origin for the same
// point of all edges: their first corner, a quarter, the middle, or anywhere.
inline std::size_t count_leaks(const RayCaster& caster, const Mesh& mesh,
                               const Eigen::Vector3d& centre, std::size_t begin, std::size_t end) {
  const std::size_t edges = 3 * mesh.triangles.size();
  std::vector<Ray> rays;
  std::vector<double> target_m;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t block = i / edges, edge = i % edges;
    RandomStream random(51, 0, block);
    const Eigen::Vector3d out = random_vector(random).normalized();
    const Eigen::Vector3d origin = centre + 0.5 * random.uniform() * out;
    const double shares[] = {0, 0.25, 0.5, random.uniform()};
    const Triangle& t = mesh.triangles[edge / 3];
    const Eigen::Vector3d &a = mesh.vertices[t[edge % 3]], &b = mesh.vertices[t[(edge + 1) % 3]];
    const Eigen::Vector3d towards = a + shares[block % 4] * (b - a) - origin;
    target_m.push_back(towards.norm());
    rays.push_back({origin, towards / target_m.back()});
  }
  std::vector<std::optional<Hit>> hits(rays.size());
  caster.closest(rays, hits);
  std::size_t leaks = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    leaks += !hits[i] || hits[i]->distance_m > target_m[i] * (1 + 1e-6);
  return leaks;
}

inline std::size_t count_leaks(const RayCaster& caster, const Mesh& mesh,
                               const Eigen::Vector3d& centre, std::size_t count) {
  return ordered_sum(count, 4096, std::size_t{0}, [&](std::size_t begin, std::size_t end) {
    return count_leaks(caster, mesh, centre, begin, end);
  });
}

}  // namespace scan::synth
