// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Hard cases of many scans: long paths on which each meets but a few others.
#include <gtest/gtest.h>

#include "tests/align/simulated_path.h"

namespace scan {
namespace {

// Each scan shares 60 % with the next, 20 % with the one after that, and of its places nothing with
// any other: what is between neighbours must stand as well as the pairs have it, and the far end
// where the errors of 299 links, added up, may put it.
TEST(HardPath, ThreeHundredScansInARowStayTied) {
  constexpr std::size_t scans = 300;
  const test::SimulatedViews path =
      test::simulated_path(test::ScannerNoise::lidar, scans, 30, 0.8, 1);
  const MultiviewResult result = align_scans(path.clouds, path.guesses);
  std::size_t tied = 0;
  for (const ScanPose& scan : result.scans)
    tied += scan.stop == Stop::converged || scan.stop == Stop::degenerate;
  EXPECT_EQ(tied, scans);
  double sum = 0, links = 0;
  for (const ScanEdge& edge : result.edges)
    if (edge.target == edge.source + 1 && edge.accepted && edge.stop == Stop::converged) {
      sum += test::normalised_link_error2(result, path.truth, edge) / 6;
      ++links;
    }
  EXPECT_GT(links, 0.9 * scans);
  // A mean of chi-squares over six degrees of freedom has a standard error of sqrt(2 / 6 / 270)
  // = 0.035; a tenth of bias is what calibration allows a pair.
  EXPECT_LT(sum / links, 1 + 0.1 + 3 * 0.035);
}

}  // namespace
}  // namespace scan
