// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The SSD function of scattered samples: as smooth as their noise asks for, region by region.
#pragma once

#include "libscan/core/progress.h"
#include "libscan/reconstruct/far_places.h"
#include "libscan/reconstruct/ssd_solver.h"

namespace scan {

struct SsdFit {
  SsdSolution solution;
  std::vector<double> length;  // smoothing length at each sample, unit cube
  std::vector<double> trust;   // in each sample, see below
};

struct SsdFitOptions {
  double length = 0;             // least smoothing length, unit cube; 0: chosen
  double relative_residual = 0;  // 0: chosen
  int max_iterations = 2000;
};

// The samples' weights for a smoothing length at each (local_smoothing.h): value 4 area / length^3;
// gradient that times 0.03 length^2, and area / 12 more where samples are exact, for there a normal
// speaks for the patch of its sample. With these the weight of the smoothness is one, at any scale
// and density.
// Both times `trust`, see below.
SampleWeights smoothing_weights(const Samples& samples, const std::vector<double>& length,
                                const std::vector<double>& trust);

// One for samples that a fit of this smoothing length leaves no farther off than is usual: within 4
// sigma, half a spacing, half the length or twice the mean size of the residuals around;
// (tolerance / residual)^4 for those farther off. With lengths that fall from fit to fit a stray
// sample does not gain the weight to pull the surface to itself.
std::vector<double> trust(const Samples& samples, const std::vector<double>& residuals,
                          const std::vector<double>& mean_around, double length);

// With what is 0 chosen from all samples' spacing and scatter.
SsdFitOptions chosen_for(const Samples& samples, SsdFitOptions options);

// From the coarsest level to the finest: each is solved with a smoothing length in step with its
// cells, and keeps it in the regions where that lowers the risk; past the finest level the length
// alone goes on. Then all is solved once more for the lengths found.
SsdFit fit_surface(const OctreeGrid& grid, const Samples& samples, const SsdFitOptions& options,
                   const Progress& progress = {});

// Once more from there, with the same lengths and trust, and f drawn to the distances of `far` as
// if it had samples there whose smoothing length is their distance from all others.
void fit_again(const OctreeGrid& grid, const Samples& samples, const FarPlaces& far,
               const SsdFitOptions& options, SsdFit& fit);

}  // namespace scan
