// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The inputs by which reconstruction methods are compared: known surfaces, sampled, with noise,
// gaps, stray points, wrong normals or scanners' views. The same bytes for the same name and count.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libscan/core/point_cloud.h"
#include "libscan/verify/truth.h"

namespace scan {

struct ReconstructInput {
  std::string name;
  PointCloud cloud;                         // world frame, rounded to floats; unit normals
  std::vector<Eigen::Vector3d> viewpoints;  // of each point's scanner; empty: unknown
  TrueSurface truth;
  double diagonal_m = 0;  // of the true surface's box
};

// sphere, torus, csg, bunny, smooth-bunny, plate: exact samples and true normals. NAME-0.1, -0.5,
// -1: isotropic Gaussian noise in per cent of the diagonal; normals are then plane fits over 20, 40
// or 60 neighbours, turned as the true ones. bunny-outliers-5 and -20: uniform in 1.2 times the box
// with random normals, in per cent of the samples, at 0.1 % noise. bunny-flipped-10, -30: that many
// normals turned round, -patch: all within 20 % of the diagonal of one end. NAME-density: sampled
// up to 200 times as densely on one end; NAME-holes: six balls of 7 % of the diagonal are missing;
// both at 0.05 % noise. bunny-5000: so many exact samples. sphere-cap: z > 0.3 of the sphere, 0.05
// % noise. NAME-views: what ten scanners about it see, with 0.05 % noise along the ray over the
// cosine of incidence; bunny-views: each view also displaced by 0.08 % and turned by 0.15 % rad.
// anchor-3000, lordquas-3000: the scans of the reconstruction benchmark (Berger et al. 2013).
// bunny-scans: Stanford's ten scans, whose truth is their zippered mesh.
const std::vector<std::string>& reconstruct_input_names();

// `data`: the folder that holds stanford-bunny and reconbench. `count`: samples, where the name
// does not say it; outliers come on top. Throws scan::Error (usage) for another name and (input)
// for missing files.
ReconstructInput make_reconstruct_input(const std::string& name, const std::filesystem::path& data,
                                        std::size_t count = 100'000);

}  // namespace scan
