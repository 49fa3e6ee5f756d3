// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/trim.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"

namespace scan {
namespace {

// Two unit squares side by side, of two triangles each, and a small triangle apart.
SurfaceResult strip() {
  SurfaceResult result;
  result.surface.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0},   {0, 1, 0},  {1, 1, 0},
                             {2, 1, 0}, {5, 5, 0}, {5.1, 5, 0}, {5, 5.1, 0}};
  result.surface.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {6, 7, 8}};
  result.support_m = {0, 0, 9, 0, 0, 9, 0, 0, 0};
  result.data_spacing_m = {1, 1, 2.5, 1, 1, 3.5, 1, 1, 1};
  result.standard_error_m = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  return result;
}

TEST(Trim, RemovesWhatIsFarFromDataAndSmallParts) {
  SurfaceResult result = strip();
  const TrimReport report = trim(result, 1.0, 0.1);
  EXPECT_EQ(report.removed_triangles, 3u);
  EXPECT_NEAR(report.removed_area_m2, 1.005, 1e-15);
  EXPECT_EQ(result.trimmed_area_m2, report.removed_area_m2);
  EXPECT_EQ(result.surface.vertices.size(), 4u);
  EXPECT_EQ(result.support_m, std::vector<double>(4, 0.0));
  EXPECT_EQ(result.standard_error_m, (std::vector<double>{1, 2, 4, 5}));
  EXPECT_EQ(result.data_spacing_m, std::vector<double>(4, 1.0));
  EXPECT_NEAR(area_m2(result.surface), 1, 1e-15);
}

// The second quad loses a corner and goes whole, though one half is near the data.
TEST(Trim, KeepsOrRemovesQuadsWhole) {
  SurfaceResult result = strip();
  result.surface.triangles = {{0, 1, 4}, {0, 4, 3}, {4, 1, 2}, {4, 2, 5}, {6, 7, 8}};
  result.surface.quads = 2;
  result.support_m = {0, 0, 0, 0, 0, 9, 0, 0, 0};
  trim(result, 1.0, 0);
  EXPECT_EQ(result.surface.quads, 1u);
  EXPECT_EQ(result.surface.triangles, (std::vector<Triangle>{{0, 1, 3}, {0, 3, 2}, {4, 5, 6}}));
}

// Of the two vertices 9 m from data one lies more than three spacings off, in one triangle and both
// in another.
TEST(Trim, LeavesNoUnsupportedArea) {
  SurfaceResult result = strip();
  EXPECT_NEAR(unsupported_area_m2(result), 0.5, 1e-15);
  trim(result, 1.0, 0);
  EXPECT_EQ(unsupported_area_m2(result), 0);
}

TEST(Trim, KeepsSmallPartsWhenAskedTo) {
  SurfaceResult result = strip();
  EXPECT_EQ(trim(result, 1.0, 0).removed_triangles, 2u);
}

TEST(Trim, RefusesSurfacesWithoutDistances) {
  SurfaceResult result = strip();
  result.support_m.pop_back();
  EXPECT_THROW(trim(result, 1.0), Error);
  result = strip();
  EXPECT_THROW(trim(result, -1.0), Error);
}

}  // namespace
}  // namespace scan
