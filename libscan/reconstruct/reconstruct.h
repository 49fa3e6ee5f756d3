// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Points to a surface, by any method.
//
// To add a method: 1. its own header and source; 2. its name in ReconstructMethod and in the list
// of names in reconstruct.cpp; 3. its case in reconstruct(): the compiler names it; 4. its line in
// the README. reconstruct_test.cpp and the hard cases walk the list.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "libscan/core/progress.h"
#include "libscan/reconstruct/moving_least_squares.h"
#include "libscan/reconstruct/prepare_points.h"
#include "libscan/reconstruct/range_fusion.h"
#include "libscan/reconstruct/rbf.h"
#include "libscan/reconstruct/ssd.h"

namespace scan {

enum class ReconstructMethod {
  automatic,
  ssd,
  poisson,
  mls,
  rbf,
  range_fusion,
  delaunay,
  scale_space,
  power_crust
};

// In the order of the enumeration, as they are written.
const std::vector<std::string>& reconstruct_method_names();
std::string_view name_of(ReconstructMethod method);

struct ReconstructOptions {
  ReconstructMethod method = ReconstructMethod::ssd;
  SsdOptions ssd;
  MlsOptions mls;
  RbfOptions rbf;
  RangeFusionOptions range_fusion;
  // Edges and corners put back (sharp_features.h); by SSD the points moved up to them before, where
  // these scatter too much for that (bilateral_samples.h).
  bool sharp = false;
  bool quads = false;  // the dual surface (dual_mesh.h), for methods that cut one out of cells
};

// Prepares the points (prepare_points.h) and calls the method; `automatic` ("auto") is one that
// choose_method.h chooses, trimmed if that says so, and if it is SSD moves points up to creases.
// `viewpoints`: where the scanner of each point stood, or empty. Throws what the method throws, and
// scan::Error (input) for fewer than 4 finite points or for points at one place or on one line:
// they span no surface.
SurfaceResult reconstruct(const PointCloud& cloud, std::span<const Eigen::Vector3d> viewpoints,
                          const ReconstructOptions& options = {}, const Progress& progress = {});

}  // namespace scan
