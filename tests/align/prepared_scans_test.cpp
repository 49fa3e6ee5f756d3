// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/prepared_scans.h"

#include <gtest/gtest.h>

namespace scan {
namespace {

// A plane's lattice of 40 x 40 points, `spacing_m` apart and 0.1 of that off the origin.
PointCloud lattice(double spacing_m) {
  PointCloud cloud;
  for (int i = 0; i < 1600; ++i)
    cloud.points.push_back(spacing_m * Eigen::Vector3d(i % 40 + 0.1, i / 40 + 0.1, 0));
  return cloud;
}

// Of the spacings 1, 2 and 4 mm the median is 2 mm and the voxels' side 4 mm: of the finest lattice
// one point in 16 stays, 10 x 10, of the middle one one in 4, 20 x 20, and the coarsest is whole.
// Where voxels begin may add a row and a column.
TEST(PreparedScans, AreThinnedAlikeByTheirMedianSpacing) {
  const std::vector<PointCloud> clouds{lattice(0.001), lattice(0.002), lattice(0.004)};
  const PreparedScans scans = prepare_scans(clouds, {});
  const std::size_t sides[] = {10, 20, 40};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GE(scans.clouds[i].size(), std::min<std::size_t>(1600, sides[i] * sides[i]));
    EXPECT_LE(scans.clouds[i].size(), (sides[i] + 1) * (sides[i] + 1));
  }
  EXPECT_EQ(scans.tolerance_m.size(), 3u);
}

// One row of 40 has 4.1 times the others' sigma, and the next 3.9 times.
TEST(PreparedScans, LeaveOutPointsOfFourTimesTheMedianSigma) {
  PointCloud cloud = lattice(0.01);
  cloud.sigma_m.assign(1600, 1e-4);
  std::fill_n(cloud.sigma_m.begin(), 40, 4.1e-4);
  std::fill_n(cloud.sigma_m.begin() + 40, 40, 3.9e-4);
  const std::vector<PointCloud> clouds{cloud};
  EXPECT_EQ(prepare_scans(clouds, {.thin_m = 1e-3}).clouds[0].size(), 1560u);
}

}  // namespace
}  // namespace scan
