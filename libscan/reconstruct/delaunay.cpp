// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/delaunay.h"

#include "libscan/core/error.h"
#ifdef LIBSCAN_WITH_CGAL
#include "libscan/reconstruct/advancing_front.h"
#include "libscan/reconstruct/interpolating_surface.h"
#endif

namespace scan {

#ifdef LIBSCAN_WITH_CGAL
SurfaceResult delaunay(const PointCloud& cloud) {
  return interpolating_surface(cloud, advancing_front, "delaunay");
}
#else
SurfaceResult delaunay(const PointCloud&) {
  throw Error(Trouble::usage, "delaunay: libscan was built without CGAL",
              "configure with -DLIBSCAN_WITH_CGAL=ON");
}
#endif

}  // namespace scan
