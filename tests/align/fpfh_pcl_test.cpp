// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The Point Cloud Library's FPFH as an oracle for ours.
#include <gtest/gtest.h>
#include <pcl/features/fpfh.h>
#include <pcl/point_types.h>

#include "libscan/align/fpfh.h"
#include "tests/align/test_shapes.h"

namespace scan {
namespace {

pcl::PointCloud<pcl::FPFHSignature33> pcl_fpfh(const PointCloud& cloud, double radius_m) {
  const auto points = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  const auto normals = std::make_shared<pcl::PointCloud<pcl::Normal>>();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f x = cloud.points[i].cast<float>(), n = cloud.normals[i].cast<float>();
    points->emplace_back(x.x(), x.y(), x.z());
    normals->emplace_back(n.x(), n.y(), n.z());
  }
  pcl::FPFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(points);
  estimation.setInputNormals(normals);
  estimation.setRadiusSearch(radius_m);
  pcl::PointCloud<pcl::FPFHSignature33> histograms;
  estimation.compute(histograms);
  return histograms;
}

// PCL computes in single precision: an angle is off by some 1e-6, so that of the 3 x 60 angles of a
// point one in 3e4 falls into the next bin, and a neighbour on the edge of the radius counts or
// does not. A pair that changes bins moves 1 / 60 of the weight of one neighbour's histogram, and
// a point has 60 neighbours: few values differ at all, and on average the difference is nought.
TEST(Fpfh, AgreesWithThePointCloudLibrary) {
  PointCloud cloud = test::bumpy_surface(1500, 3);
  for (Eigen::Vector3d& x : cloud.points) x = x.cast<float>().cast<double>();
  for (Eigen::Vector3d& n : cloud.normals) n = n.cast<float>().cast<double>();
  const auto ours = fpfh(cloud, KdTree(cloud.points), 0.2);
  const auto theirs = pcl_fpfh(cloud, 0.2);
  ASSERT_EQ(theirs.size(), ours.size());
  double sum = 0;
  std::size_t different = 0;
  for (std::size_t i = 0; i < ours.size(); ++i)
    for (std::size_t k = 0; k < ours[i].size(); ++k) {
      const double off = std::abs(ours[i][k] - theirs[i].histogram[k]);
      sum += off;
      different += off > 1e-2;
    }
  const double values = double(ours.size()) * double(ours[0].size());
  EXPECT_LT(sum / values, 1e-4);
  EXPECT_LT(double(different) / values, 1e-3);
  std::cout << "  mean difference " << sum / values
            << ", share beyond 0.01: " << double(different) / values << "\n";
}

}  // namespace
}  // namespace scan
