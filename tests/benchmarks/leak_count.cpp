// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Counts the rays that slip through a closed mesh at its vertices and edges: leak_count [millions
// of rays, 1000 unless told]. Half of them near the origin, half 1e6 m away. Ends with 1 if any do.
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "tests/synth/structured_rays.h"

int main(int argc, char** argv) {
  using namespace scan::synth;
  const double millions = argc > 1 ? std::atof(argv[1]) : 1000;
  const auto count = static_cast<std::size_t>(millions * 0.5e6);
  std::size_t leaks = 0;
  const auto start = std::chrono::steady_clock::now();
  for (const double offset_m : {0.0, 1e6}) {
    const Eigen::Vector3d centre(offset_m, -offset_m, offset_m);
    scan::Mesh mesh = bumpy_ball(50, 100);
    for (Eigen::Vector3d& v : mesh.vertices) v += centre;
    leaks += count_leaks(RayCaster(scene_of({mesh})), mesh, centre, count);
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  std::printf("%zu leaks in %zu rays, %.0f s\n", leaks, 2 * count, taken.count());
  return leaks == 0 ? 0 : 1;
}
