// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Self-intersections, where CGAL is there to count them.
#include "libscan/verify/self_intersection.h"

#include "libscan/verify/count_self_intersections.h"

namespace scan {

std::optional<Measurement> self_intersection(const Mesh& mesh) {
  check(mesh);
#ifdef LIBSCAN_WITH_CGAL
  const auto count = count_self_intersections(mesh);
  if (!count) return std::nullopt;
  return Measurement{.name = "self_intersections",
                     .value = static_cast<double>(*count),
                     .unit = "count",
                     .over = "pairs of triangles that cross",
                     .count = mesh.triangles.size()};
#else
  return std::nullopt;
#endif
}

}  // namespace scan
