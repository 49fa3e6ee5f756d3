// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "libscan/align/icp.h"
#include "libscan/core/error.h"
#include "tests/align/icp_methods.h"
#include "tests/align/test_shapes.h"

namespace scan {
namespace {

TEST(IcpOptions, AreRefusedBeyondTheirLimits) {
  const PointCloud cloud = test::bumpy_surface(100, 17);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.max_pair_distance_m = -1}), Error);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.trim_fraction = 1}), Error);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.max_iterations = 0}), Error);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.min_overlap = 1.1}), Error);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.stop_rotation_rad = std::nan("")}), Error);
  Pose bad = Pose::Identity();
  bad.translation().x() = std::nan("");
  EXPECT_THROW(icp(cloud, cloud, bad), Error);
}

TEST(IcpMethod, NamesGoThereAndBack) {
  for (const IcpMethod method : test::icp_methods)
    EXPECT_EQ(icp_method_from(name_of(method)), method);
  EXPECT_FALSE(icp_method_from("nearest"));
  EXPECT_EQ(name_of(Stop::no_correspondences), "no correspondences");
}

}  // namespace
}  // namespace scan
