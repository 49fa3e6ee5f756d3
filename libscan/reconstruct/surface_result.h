// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What every reconstruction method returns.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "libscan/core/cost.h"
#include "libscan/core/mesh.h"

namespace scan {

enum class SolveStop { converged, iteration_limit, direct };
std::string_view name_of(SolveStop stop);

// What putting sharp features back has done (sharp_features.h).
struct SharpReport {
  std::size_t moved_vertices = 0;
  std::size_t edge_vertices = 0;  // on sharp edges now, corners counted
  std::size_t corners = 0;
};

// What decimation has done (decimate.h).
struct DecimateReport {
  double tolerance_m = 0;
  double bound_m = 0;                // of the distance between the surfaces, both ways
  std::size_t triangles_before = 0;  // 0: nothing was asked for
  bool is_proven = false;            // else the surface stayed as it was
};

// What solving part by part has done (ssd_parts.h).
struct PartsReport {
  std::size_t parts_per_axis = 1;
  // How far apart the surfaces of neighbouring parts are where they are blended, at the points.
  double seam_rms_m = 0, seam_largest_m = 0;
  std::size_t seam_points = 0;
};

struct SurfaceResult {
  Mesh surface;
  std::string method;                  // set by reconstruct()
  std::string method_reason;           // why this one
  std::vector<double> support_m;       // per vertex: distance to the nearest data point
  std::vector<double> data_spacing_m;  // per vertex: how far apart the data are there
  // Per vertex: one standard deviation across the surface, from the points' scatter and the
  // smoothing; of the surface beside the nearest point. Points are taken for independent and their
  // poses for right, unless add_standard_errors() (surface_uncertainty.h) counts what they share;
  // infinite where that is not known. Empty: the method does not know.
  std::vector<double> standard_error_m;
  // Per vertex: the smoothing length beside it; empty: the method has none.
  std::vector<double> vertex_smoothing_m;
  double finest_cell_m = 0;  // that the surface was cut out of; 0: of none
  Eigen::Vector3d cells_from_m = Eigen::Vector3d::Zero();  // a corner of theirs
  int depth = 0;                                           // of the solution's finest cells
  double sigma_m = 0;             // scatter of the points, median; given or estimated
  double smoothing_length_m = 0;  // median; ripples of 2 pi times this are halved
  std::size_t unknowns = 0;
  int iterations = 0;
  double relative_residual = 0;
  SolveStop stop = SolveStop::iteration_limit;
  std::size_t invalid_points = 0;     // not finite or without a normal, left out
  std::size_t outlying_points = 0;    // on no surface, left out
  std::size_t estimated_normals = 0;  // were missing
  std::size_t turned_normals = 0;     // pointed the wrong way
  std::size_t moved_points = 0;       // to averages that stop at creases (bilateral_samples.h)
  PartsReport parts;
  SharpReport sharp;
  DecimateReport decimation;
  double trimmed_area_m2 = 0;  // of surface without support, cut away
  Cost cost;
};

// Surface within so many spacings of the data is supported: of random samples one is as near with
// probability 1 - exp(-9 pi). Farther off it is a guess that goes on from around.
inline constexpr int supported_within_spacings = 3;

// Of the triangles with a vertex that is not supported; 0 if the spacing of the data is not known.
double unsupported_area_m2(const SurfaceResult& result);

}  // namespace scan
