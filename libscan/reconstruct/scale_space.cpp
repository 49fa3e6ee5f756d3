// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/scale_space.h"

#include "libscan/core/error.h"
#ifdef LIBSCAN_WITH_CGAL
#include "libscan/reconstruct/cgal_scale_space.h"
#include "libscan/reconstruct/interpolating_surface.h"
#endif

namespace scan {

#ifdef LIBSCAN_WITH_CGAL
SurfaceResult scale_space(const PointCloud& cloud) {
  constexpr int smoothings = 4;  // CGAL's own choice
  const auto triangulate = [](std::span<const Eigen::Vector3d> points) {
    return cgal_scale_space(points, smoothings);
  };
  return interpolating_surface(cloud, triangulate, "scale-space");
}
#else
SurfaceResult scale_space(const PointCloud&) {
  throw Error(Trouble::usage, "scale-space: libscan was built without CGAL",
              "configure with -DLIBSCAN_WITH_CGAL=ON");
}
#endif

}  // namespace scan
