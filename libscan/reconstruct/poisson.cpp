// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/poisson.h"

#include <string>

#include "libscan/core/error.h"
#include "libscan/reconstruct/support.h"
#ifdef LIBSCAN_WITH_CGAL
#include "libscan/reconstruct/cgal_poisson.h"
#endif

namespace scan {

#ifdef LIBSCAN_WITH_CGAL
SurfaceResult poisson(const PointCloud& cloud) {
  check(cloud);
  const Stopwatch watch;
  std::vector<std::uint32_t> valid;
  for (std::uint32_t i = 0; i < cloud.normals.size(); ++i)
    if (cloud.points[i].allFinite() && std::abs(cloud.normals[i].norm() - 1) < 1e-6)
      valid.push_back(i);
  if (valid.size() < 4)
    throw Error(Trouble::input, "cloud: " + std::to_string(valid.size()) +
                                    " points with a unit normal, at least 4 needed");
  const PointCloud used = subset(cloud, valid);
  SurfaceResult result;
  result.surface = cgal_poisson(used);
  if (result.surface.empty())
    throw Error(Trouble::computation, "poisson: no surface fits the points",
                "check that the normals are oriented consistently");
  sort_triangles(result.surface);
  result.support_m = distance_to_points(result.surface, used.points);
  result.unknowns = used.size();
  result.stop = SolveStop::direct;
  result.invalid_points = cloud.size() - used.size();
  result.cost.seconds = watch.seconds();
  return result;
}
#else
SurfaceResult poisson(const PointCloud&) {
  throw Error(Trouble::usage, "poisson: libscan was built without CGAL",
              "configure with -DLIBSCAN_WITH_CGAL=ON");
}
#endif

}  // namespace scan
