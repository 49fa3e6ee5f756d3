// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/far_places.h"

#include <cmath>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/winding_number.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr int cells = 16;
constexpr double least_on_surface = 0.3;  // 1/2 on a closed surface
constexpr double clearly = 0.25;          // off that of the surface

Eigen::Vector3d centre(std::size_t cell) {
  return (Eigen::Vector3d(static_cast<double>(cell % cells),
                          static_cast<double>(cell / cells % cells),
                          static_cast<double>(cell / (cells * cells))) +
          Eigen::Vector3d::Constant(0.5)) /
         cells;
}

}  // namespace

FarPlaces misjudged_places(const SplineField& field, const Samples& samples) {
  const WindingNumber winding(samples);
  FarPlaces misjudged;
  if (winding.on_surface() < least_on_surface) return misjudged;
  const KdTree tree(samples.points);
  std::vector<double> distances(cells * cells * cells, 0);
  parallel_for(
      distances.size(),
      [&](std::size_t i) {
        const Eigen::Vector3d place = centre(i);
        const double distance = std::sqrt(tree.nearest(place, unlimited_m)->distance2_m2);
        if (distance <= far_distance) return;
        const double f = evaluate(field, place).value, w = winding.at(place) - winding.on_surface();
        if (f <= 0 && w < -clearly) distances[i] = distance;
        if (f >= 0 && w > clearly) distances[i] = -distance;
      },
      64);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (distances[i] == 0) continue;
    misjudged.places.push_back(centre(i));
    misjudged.distances.push_back(distances[i]);
  }
  return misjudged;
}

}  // namespace scan
