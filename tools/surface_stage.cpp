// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/surface_stage.h"

#include "libscan/core/error.h"
#include "libscan/reconstruct/decimate.h"
#include "libscan/reconstruct/trim.h"
#include "libscan/search/voxel_grid.h"

namespace scan {
namespace {

void leave_out_large_sigma(PointCloud& cloud, std::vector<Eigen::Vector3d>& viewpoints,
                           CommonErrors& common, double max_sigma_m) {
  std::vector<std::uint32_t> kept;
  std::vector<Eigen::Vector3d> kept_viewpoints;
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (cloud.sigma_m[i] <= max_sigma_m) {
      kept.push_back(i);
      if (!viewpoints.empty()) kept_viewpoints.push_back(viewpoints[i]);
    }
  if (kept.empty())
    throw Error(Trouble::computation,
                "no point has a sigma of at most " + readable_length(max_sigma_m) + " (max_sigma)");
  cloud = subset(cloud, kept);
  common = subset(common, kept);
  viewpoints = std::move(kept_viewpoints);
}

// What was done to the points, as far as it was not nothing.
void tell_of_points(const SurfaceResult& result, Console& console) {
  const auto tell = [&](std::size_t count, const char* what) {
    if (count > 0) console.warn(std::to_string(count) + what);
  };
  tell(result.invalid_points,
       " points without coordinates, normal or place in the box were left out");
  tell(result.outlying_points, " points that lie on no surface were left out");
  tell(result.estimated_normals, " points had no normal and got that of their neighbours' plane");
  tell(result.turned_normals, " normals contradicted their neighbours and were turned round");
}

}  // namespace

SurfaceResult make_surface(PointCloud cloud, std::vector<Eigen::Vector3d> viewpoints,
                           CommonErrors common, const ReconstructSettings& settings,
                           Console& console) {
  if (settings.quads && settings.decimate_m > 0)
    throw Error(Trouble::usage, "decimate: merges triangles, which quads are not",
                "leave out one of quads and decimate");
  if (settings.max_sigma_m > 0 && !cloud.sigma_m.empty())
    leave_out_large_sigma(cloud, viewpoints, common, settings.max_sigma_m);
  const bool thin = settings.thin_m > 0;
  if (thin) viewpoints.clear();  // a cube's mean was seen from several places
  SurfaceResult result = reconstruct(thin ? voxel_grid(cloud, settings.thin_m) : cloud, viewpoints,
                                     {.method = settings.method,
                                      .ssd = settings.ssd,
                                      .sharp = settings.sharp,
                                      .quads = settings.quads},
                                     console.progress());
  console.time("reconstruct", result.cost.seconds);
  tell_of_points(result, console);
  add_standard_errors(result, cloud, common);
  if (settings.trim_m > 0) trim(result, settings.trim_m);
  if (result.surface.triangles.empty())
    throw Error(Trouble::computation, "nothing of the surface is within " +
                                          readable_length(settings.trim_m) +
                                          " of a point (--trim)");
  if (settings.decimate_m > 0 && !decimate(result, settings.decimate_m).is_proven)
    console.warn("decimation within " + readable_length(settings.decimate_m) +
                 " could not be proven: the surface keeps all its triangles");
  return result;
}

SupportedMesh supported(const SurfaceResult& result) {
  return {result.surface, result.support_m, result.data_spacing_m, result.standard_error_m};
}

}  // namespace scan
