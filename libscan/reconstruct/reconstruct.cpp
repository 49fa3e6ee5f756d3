// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/reconstruct.h"

#include <Eigen/Eigenvalues>

#include "libscan/core/error.h"
#include "libscan/reconstruct/choose_method.h"
#include "libscan/reconstruct/delaunay.h"
#include "libscan/reconstruct/dual_mesh.h"
#include "libscan/reconstruct/poisson.h"
#include "libscan/reconstruct/power_crust.h"
#include "libscan/reconstruct/scale_space.h"
#include "libscan/reconstruct/sharp_features.h"
#include "libscan/reconstruct/support.h"
#include "libscan/reconstruct/trim.h"

namespace scan {
namespace {

// The points may move with `sharp`, or where all is left to this library.
SurfaceResult surface_by(ReconstructMethod method, PreparedPoints& points,
                         const ReconstructOptions& options, const Progress& progress) {
  switch (method) {
    case ReconstructMethod::automatic:
      break;  // chosen before
    case ReconstructMethod::ssd:
      return options.sharp || options.method == ReconstructMethod::automatic
                 ? ssd_up_to_creases(points.cloud, points.spacing_m, options.ssd, progress)
                 : ssd(points.cloud, options.ssd, progress);
    case ReconstructMethod::poisson:
      return poisson(points.cloud);
    case ReconstructMethod::mls:
      return mls(points.cloud, options.mls, progress);
    case ReconstructMethod::rbf:
      return rbf(points.cloud, options.rbf, progress);
    case ReconstructMethod::range_fusion:
      return range_fusion(points.cloud, points.viewpoints, options.range_fusion, progress);
    case ReconstructMethod::delaunay:
      return delaunay(points.cloud);
    case ReconstructMethod::scale_space:
      return scale_space(points.cloud);
    case ReconstructMethod::power_crust:
      return power_crust(points.cloud, points.spacing_m);
  }
  throw Error(Trouble::usage, "reconstruct: unknown method");
}

// Roots of the points' moments about their mean, ascending: thickness, width and length.
Eigen::Vector3d spread_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& x : points) mean += (x - points.front()) / static_cast<double>(points.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const auto& x : points) {
    const Eigen::Vector3d d = x - points.front() - mean;
    moments += d * d.transpose() / static_cast<double>(points.size());
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments)
      .eigenvalues()
      .cwiseMax(0)
      .cwiseSqrt();
}

// Eigenvalues are right to 1e-16 of the largest, their roots to 1e-8; CGAL's Poisson is lost
// without a volume.
void require_extent(const PointCloud& cloud, ReconstructMethod method) {
  const Eigen::Vector3d spread = spread_of(cloud.points);
  if (!(spread[1] > 1e-7 * spread[2]))
    throw Error(Trouble::input,
                "cloud: its points lie at one place or on one line, which spans no surface");
  if (method == ReconstructMethod::poisson && !(spread[0] > 1e-7 * spread[2]))
    throw Error(Trouble::computation, "poisson: the points lie in one plane, which has no inside",
                "try mls or delaunay");
}

// Quads, edges and corners put back, or both.
SharpReport reshape(SurfaceResult& result, const PreparedPoints& prepared,
                    const ReconstructOptions& options) {
  const auto& [points, normals] = std::tie(prepared.cloud.points, prepared.cloud.normals);
  if (options.quads && options.sharp) {
    const OneSidedFits fits(points, normals, prepared.spacing_m);
    return make_dual(result, points, &fits);
  }
  if (options.quads) return make_dual(result, points);
  if (options.sharp) return sharpen(result, points, normals, prepared.spacing_m);
  return {};
}

}  // namespace

const std::vector<std::string>& reconstruct_method_names() {
  static const std::vector<std::string> names{"auto",     "ssd",         "poisson",
                                              "mls",      "rbf",         "range-fusion",
                                              "delaunay", "scale-space", "power-crust"};
  return names;
}

std::string_view name_of(ReconstructMethod method) {
  return reconstruct_method_names()[static_cast<std::size_t>(method)];
}

SurfaceResult reconstruct(const PointCloud& cloud, std::span<const Eigen::Vector3d> viewpoints,
                          const ReconstructOptions& options, const Progress& progress) {
  const Stopwatch watch;
  if (progress) progress("points", 0);
  PreparedPoints points = prepare_points(cloud, viewpoints);
  MethodChoice choice{.method = options.method, .reason = "asked for"};
  if (options.method == ReconstructMethod::automatic) choice = choose_method(points);
  require_extent(points.cloud, choice.method);
  SurfaceResult result = surface_by(choice.method, points, options, progress);
  if (choice.trim_m > 0) trim(result, choice.trim_m);
  result.method = name_of(choice.method);
  result.method_reason = choice.reason;
  result.invalid_points += points.invalid_points;
  result.outlying_points += points.outlying_points;
  result.estimated_normals = points.estimated_normals;
  result.turned_normals = points.turned_normals;
  result.sharp = reshape(result, points, options);
  result.data_spacing_m = of_nearest_points(result.surface, points.cloud.points, points.spacing_m);
  result.cost.seconds = watch.seconds();
  return result;
}

}  // namespace scan
