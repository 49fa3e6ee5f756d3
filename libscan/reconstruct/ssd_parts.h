// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// SSD of more samples than memory holds at once: part by part, blended in the field.
#pragma once

#include "libscan/reconstruct/blended_field.h"
#include "libscan/reconstruct/ssd_fit.h"

namespace scan {

struct SsdProblem {
  const Samples& samples;
  std::span<const int> depths;  // of the samples
  int complete_depth;
  int surface_depth;  // of the mesh
};

// Most memory that a fit of all samples at once takes, GiB, from the octree's blocks and the number
// of samples; within a factor of 1.5 of what is measured (ssd_parts_test.cpp). Counting stops above
// `enough_gib`.
double forecast_gib(const SsdProblem& problem, double enough_gib);

// Likewise of a fit in parts (split: blended_field.h): the samples, what all parts leave behind,
// and the largest part's fit or the mesh, whichever takes more.
double forecast_in_parts_gib(const SsdProblem& problem, int split, double enough_gib);

// The least split whose fits need no more than `limit_gib`; 0: all at once.
// Throws scan::Error (resource) if even parts as small as blending allows need more.
int needed_split(const SsdProblem& problem, double limit_gib);

struct SsdParts {
  int split = 0;
  std::vector<OctreeGrid> grids;  // of each field; only what evaluating it needs
  std::vector<LevelArrays> coefficients;
  std::vector<std::uint32_t> field_of_part;
  std::vector<double> length;    // smoothing length at each sample
  int iterations = 0;            // of all parts together
  double relative_residual = 0;  // the largest
  SolveStop stop = SolveStop::converged;
  int finest_depth = 0;
  std::size_t unknowns = 0;
  BlendedField field() const;
};

// Each part is fitted to its samples, to those within 1/8 of its side around, and to a thinned rest
// of the cloud, so that the parts agree where data is far. Parts without samples share the field of
// the thinned cloud alone.
SsdParts fit_parts(const SsdProblem& problem, const SsdFitOptions& options, int split,
                   const Progress& progress = {});

// How far apart the surfaces of parts are at samples where both have a share, unit cube.
struct SeamDeviation {
  double rms = 0, largest = 0;
  std::size_t samples = 0;
};
SeamDeviation seam_deviation(const SsdParts& parts, const Samples& samples);

}  // namespace scan
