// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/prepared_scans.h"

#include "libscan/align/agreement.h"
#include "libscan/core/median.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

// Thinning keeps about every fourth point of a surface.
constexpr double thin_in_spacings = 2;
// A ray's sigma grows with the inverse of the cosine of incidence, while what it errs by across the
// surface does not: beyond this lie rays that graze by less than ten degrees where most meet the
// surface at 45. Chosen, of 2 to 6: with twice the median the few steep faces that hold a slide
// are lost.
constexpr double most_sigma_in_medians = 4;

// Without the points whose sigma is far beyond the scan's median: readings at grazing incidence and
// beside edges, which slide along the surface rather than off it and bend the normals around them.
PointCloud without_weak_points(PointCloud cloud) {
  if (cloud.sigma_m.empty()) return cloud;
  const double limit_m = most_sigma_in_medians * median(cloud.sigma_m);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (cloud.sigma_m[i] <= limit_m) kept.push_back(i);
  return subset(cloud, kept);
}

}  // namespace

PreparedScans prepare_scans(std::span<const PointCloud> clouds, const MultiviewOptions& options) {
  std::vector<PointCloud> finite(clouds.size());
  std::vector<double> spacings(clouds.size());
  parallel_for(
      clouds.size(),
      [&](std::size_t i) {
        finite[i] = without_weak_points(subset(clouds[i], finite_points(clouds[i])));
        if (options.thin_m == 0)
          spacings[i] = spacing_m(finite[i].points, KdTree(finite[i].points));
      },
      1);
  std::erase(spacings, 0);
  const double side_m =
      options.thin_m > 0 ? options.thin_m : thin_in_spacings * median(std::move(spacings));
  PreparedScans scans;
  scans.clouds.resize(clouds.size());
  scans.tolerance_m.resize(clouds.size());
  parallel_for(
      clouds.size(),
      [&](std::size_t i) {
        scans.clouds[i] = prepare(finite[i], {.thin_m = side_m, .search = options.icp.search});
        scans.tolerance_m[i] = tolerated_residual_m(scans.clouds[i], median(finite[i].sigma_m));
        finite[i] = {};
      },
      1);
  return scans;
}

}  // namespace scan
