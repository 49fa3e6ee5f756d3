// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far a measured surface or cloud lies from the true surface, and the other way round.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "libscan/core/mesh.h"
#include "libscan/verify/truth.h"
#include "libscan/verify/verdict.h"

namespace scan {

// Distances to a TrueSurface, prepared once. Analytic shapes by their own field, meshes exactly by
// point and triangle.
class TrueDistance {
 public:
  explicit TrueDistance(const TrueSurface& surface);
  ~TrueDistance();
  TrueDistance(TrueDistance&&) noexcept;

  struct Nearest {
    Eigen::Vector3d point;
    Eigen::Vector3d normal;    // outward, unit
    double signed_distance_m;  // positive outside, by the side of the normal
  };
  Nearest nearest(const Eigen::Vector3d& x_in_world) const;
  // Of each point, on all threads; NaN for points that are not finite. Quicker than one by one.
  std::vector<Nearest> nearest_of_each(std::span<const Eigen::Vector3d> points_in_world) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

struct SurfaceErrorOptions {
  // Drawn on each surface that is not a point set; for meshes doubled up to three times until the
  // 95 % intervals of both means are within 1 % of them, or of 1e-6 of the diagonal.
  std::size_t samples = 200'000;
  std::uint64_t seed = 1;
  double f_score_threshold_m = 0;  // 0: one hundredth of the truth's bounding-box diagonal
  // Completeness counts only truth samples within this distance of some `seen` point; empty: all.
  std::span<const Eigen::Vector3d> seen_points = {};
  double seen_distance_m = 0;
};

// accuracy_mean, _rms, _median, _p95, _p997, _max (measured to truth, unsigned), the same of
// completeness (truth to measured), hausdorff (the larger of the two maxima; of two meshes, all of
// which was seen, the true one, see search/hausdorff.h), f_score,
// normal_error_mean (rad, between oriented normals at the measured samples; only if normals are
// known). Throws scan::Error (input) for nothing measured, (computation)
// if no part of the truth was seen.
std::vector<Measurement> surface_error(const Mesh& measured, const TrueSurface& truth,
                                       const SurfaceErrorOptions& options = {});
std::vector<Measurement> cloud_error(const PointCloud& measured, const TrueSurface& truth,
                                     const SurfaceErrorOptions& options = {});

// Signed deviation of each point from the truth, metres, for colour maps and histograms.
std::vector<double> deviations_m(std::span<const Eigen::Vector3d> points, const TrueSurface& truth);

// `count` samples of a true surface, uniform by area, with outward normals: meshes by triangle;
// bounded shapes, combinations and blends too, where random lines cross them. Points that another
// solid of the union covers are left out. A plane has no end and is sampled inside the shadow that
// the bounded parts and `plane_region` (may be empty) cast on it. Throws scan::Error (input) if
// nothing bounds a plane, (computation) if nothing of the surface is visible.
std::vector<SurfaceSample> sample_truth(const TrueSurface& truth, std::size_t count,
                                        std::uint64_t seed, const Bounds& plane_region = Bounds());

// range_error_bias, range_error_rms, range_error_p95 (m, along the ray), ray_hit_fraction of the
// rays that truly hit, and normalised_range_error_rms and range_error_within_95
// (stated_uncertainty.h; only with a positive sigma somewhere). Of several points on one ray the
// nearest counts. Throws scan::Error (input) for a ray number that the truth does not have.
std::vector<Measurement> range_error(const PointCloud& cloud_in_scanner,
                                     std::span<const std::uint32_t> ray, const ScanTruth& truth);

// unsupported_area: share of the area that lies in triangles with a vertex farther from every data
// point than `most_spacings`; `support_spacings` has each vertex' distance to the nearest one over
// the data's spacing there. Throws scan::Error (input) for lists of different lengths.
Measurement unsupported_area(const Mesh& mesh, std::span<const double> support_spacings,
                             int most_spacings);

// components, boundary_edges, non_manifold_edges, genus (NaN unless closed and manifold).
std::vector<Measurement> topology(const Mesh& mesh);

}  // namespace scan
