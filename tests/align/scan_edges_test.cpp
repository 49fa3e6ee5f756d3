// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/scan_edges.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace scan {
namespace {

const Eigen::Vector3d arm(0.3, -0.1, 0.2);  // from the target's origin to the overlap's centre
constexpr double rms_m = 1e-3, size_m = 0.2;

PreparedScans two_scans() {
  PreparedScans scans;
  scans.clouds.resize(2);
  scans.clouds[0].radius_m = size_m;  // the source, which is the smaller one
  scans.clouds[1].radius_m = 2.5 * size_m;
  scans.clouds[1].origin = {1, 2, 3};
  return scans;
}

PoseEdge edge_of(const Matrix6& information) {
  const PreparedScans scans = two_scans();
  ScanEdge edge{.source = 0, .target = 1};
  edge.rms_m = rms_m;
  edge.centre = scans.clouds[1].origin + arm;
  edge.information = information;
  return graph_edge(scans, edge);
}

// An icp that is sure without limit leaves what a distortion may do: at the overlap's centre
// shifts of the residuals' rms, and turns of that over the size. The centre's motion follows from
// the twist about the origin as t + w x arm.
TEST(GraphEdge, IsNoSurerThanADistortionAllows) {
  const Matrix6 covariance = edge_of(1e18 * Matrix6::Identity()).information.inverse();
  Eigen::Matrix<double, 3, 6> motion_of_centre;
  motion_of_centre << -cross_matrix(arm), Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d shift = motion_of_centre * covariance * motion_of_centre.transpose();
  const double turn = rms_m / size_m;
  // 1e18 stands for infinity: its 1e-18 are 1e-12 of the smallest variance.
  EXPECT_TRUE(shift.isApprox(rms_m * rms_m * Eigen::Matrix3d::Identity(), 1e-9)) << shift;
  EXPECT_TRUE(
      (covariance.topLeftCorner<3, 3>().isApprox(turn * turn * Eigen::Matrix3d::Identity(), 1e-9)));
}

// Far below the limit the icp's own information is kept: of half the limit a third is lost.
TEST(GraphEdge, KeepsWhatIsUnsureAnyway) {
  Vector6 limit;
  limit << Eigen::Vector3d::Constant(size_m * size_m / (rms_m * rms_m)),
      Eigen::Vector3d::Constant(1 / (rms_m * rms_m));
  const Matrix6 whole = edge_of(1e30 * Matrix6::Identity()).information;
  const Matrix6 half = edge_of(Matrix6((0.5 * limit).asDiagonal())).information;
  EXPECT_TRUE(half.isApprox(whole / 3, 1e-9));  // 1 / (1 / 0.5 + 1) of the limit
}

TEST(GraphEdge, LeavesOpenWhatIsOpen) {
  Matrix6 information = 1e6 * Matrix6::Identity();
  information(5, 5) = 0;  // slides along z
  const Matrix6 about_origin = edge_of(information).information;
  const double others = about_origin.norm();
  EXPECT_LT(about_origin.col(5).norm(), 1e-12 * others);  // rounding
  EXPECT_GT(about_origin(3, 3), 1e-3 * others);
}

}  // namespace
}  // namespace scan
