// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/surface_stage.h"

#include "libscan/core/error.h"
#include "libscan/reconstruct/delaunay.h"
#include "libscan/reconstruct/trim.h"
#include "libscan/search/voxel_grid.h"

namespace scan {
namespace {

PointCloud without_large_sigma(const PointCloud& cloud, double max_sigma_m) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (cloud.sigma_m[i] <= max_sigma_m) kept.push_back(i);
  if (kept.empty())
    throw Error(Trouble::computation,
                "no point has a sigma of at most " + readable_length(max_sigma_m) + " (max_sigma)");
  return subset(cloud, kept);
}

}  // namespace

std::string_view name_of(ReconstructMethod method) {
  return method == ReconstructMethod::ssd ? "ssd" : "delaunay";
}

SurfaceResult make_surface(PointCloud cloud, const ReconstructSettings& settings,
                           Console& console) {
  if (settings.max_sigma_m > 0 && !cloud.sigma_m.empty())
    cloud = without_large_sigma(cloud, settings.max_sigma_m);
  if (settings.thin_m > 0) cloud = voxel_grid(cloud, settings.thin_m);
  SurfaceResult result = settings.method == ReconstructMethod::ssd
                             ? ssd(cloud, settings.ssd, console.progress())
                             : delaunay(cloud);
  console.time("reconstruct", result.cost.seconds);
  if (result.invalid_points > 0)
    console.warn(std::to_string(result.invalid_points) +
                 " points without coordinates, normal or place in the box were left out");
  if (settings.trim_m > 0) trim(result, settings.trim_m);
  if (result.surface.triangles.empty())
    throw Error(Trouble::computation, "nothing of the surface is within " +
                                          readable_length(settings.trim_m) +
                                          " of a point (--trim)");
  return result;
}

}  // namespace scan
