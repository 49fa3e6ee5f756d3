// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/reconstruct.h"

#include "libscan/core/error.h"
#include "libscan/reconstruct/delaunay.h"
#include "libscan/reconstruct/poisson.h"
#include "libscan/reconstruct/scale_space.h"

namespace scan {
namespace {

SurfaceResult surface_by(const PreparedPoints& points, const ReconstructOptions& options,
                         const Progress& progress) {
  switch (options.method) {
    case ReconstructMethod::ssd:
      return ssd(points.cloud, options.ssd, progress);
    case ReconstructMethod::poisson:
      return poisson(points.cloud);
    case ReconstructMethod::mls:
      return mls(points.cloud, options.mls, progress);
    case ReconstructMethod::range_fusion:
      return range_fusion(points.cloud, points.viewpoints, options.range_fusion, progress);
    case ReconstructMethod::delaunay:
      return delaunay(points.cloud);
    case ReconstructMethod::scale_space:
      return scale_space(points.cloud);
  }
  throw Error(Trouble::usage, "reconstruct: unknown method");
}

}  // namespace

const std::vector<std::string>& reconstruct_method_names() {
  static const std::vector<std::string> names{"ssd",          "poisson",  "mls",
                                              "range-fusion", "delaunay", "scale-space"};
  return names;
}

std::string_view name_of(ReconstructMethod method) {
  return reconstruct_method_names()[static_cast<std::size_t>(method)];
}

SurfaceResult reconstruct(const PointCloud& cloud, std::span<const Eigen::Vector3d> viewpoints,
                          const ReconstructOptions& options, const Progress& progress) {
  const Stopwatch watch;
  if (progress) progress("points", 0);
  const PreparedPoints points = prepare_points(cloud, viewpoints);
  SurfaceResult result = surface_by(points, options, progress);
  result.invalid_points += points.invalid_points;
  result.outlying_points += points.outlying_points;
  result.estimated_normals = points.estimated_normals;
  result.turned_normals = points.turned_normals;
  result.cost.seconds = watch.seconds();
  return result;
}

}  // namespace scan
