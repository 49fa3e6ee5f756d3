// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The settings of the published comparison: 20 neighbours, 1e-4 rad and 1e-4 of the unit, 100
// iterations.
#define PCL_NO_PRECOMPILE
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ndt.h>
#include <pcl/search/kdtree.h>

#include "tests/benchmarks/align_peers.h"

namespace scan::test {
namespace {

using Point = pcl::PointNormal;
using Cloud = pcl::PointCloud<Point>;

Cloud::Ptr cloud_of(const PointCloud& cloud) {
  auto made = std::make_shared<Cloud>();
  for (const Eigen::Vector3d& x : cloud.points) {
    Point point;
    point.getVector3fMap() = x.cast<float>();
    made->push_back(point);
  }
  return made;
}

Cloud::Ptr thinned(const Cloud::Ptr& cloud, double side_m) {
  if (side_m == 0) return cloud;
  auto thin = std::make_shared<Cloud>();
  pcl::VoxelGrid<Point> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(Eigen::Vector4f::Constant(static_cast<float>(side_m)));
  grid.filter(*thin);
  return thin;
}

void add_normals(const Cloud::Ptr& cloud) {
  pcl::NormalEstimation<Point, Point> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<Point>>());
  estimation.setKSearch(20);
  estimation.compute(*cloud);
}

template <class Registration>
Outcome align(const PairCase& pair, Registration& registration, bool normals) {
  Outcome outcome;
  const Cloud::Ptr whole_source = cloud_of(pair.source), whole_target = cloud_of(pair.target);
  const PairWatch watch;
  const Cloud::Ptr source = thinned(whole_source, pair.thin_m);
  const Cloud::Ptr target = thinned(whole_target, pair.thin_m);
  if (normals) add_normals(source), add_normals(target);
  outcome.prepare_s = watch.seconds();
  registration.setInputSource(source);
  registration.setInputTarget(target);
  registration.setMaxCorrespondenceDistance(pair.reach_m);
  registration.setMaximumIterations(100);
  registration.setTransformationEpsilon(1e-8);
  registration.setTransformationRotationEpsilon(1 - 0.5e-8);
  Cloud moved;
  registration.align(moved, pair.guess.matrix().cast<float>());
  outcome.align_s = watch.seconds() - outcome.prepare_s;
  outcome.pose.matrix() = registration.getFinalTransformation().template cast<double>();
  outcome.stop = registration.hasConverged() ? "converged" : "not converged";
  return outcome;
}

Outcome by_points(const PairCase& pair) {
  pcl::IterativeClosestPoint<Point, Point> registration;
  return align(pair, registration, false);
}

Outcome by_planes(const PairCase& pair) {
  pcl::IterativeClosestPointWithNormals<Point, Point> registration;
  return align(pair, registration, true);
}

Outcome by_ndt(const PairCase& pair) {
  pcl::NormalDistributionsTransform<Point, Point> registration;
  registration.setResolution(static_cast<float>(pair.step_m));
  registration.setStepSize(0.1 * pair.step_m);
  return align(pair, registration, false);
}

Outcome by_gicp(const PairCase& pair) {
  pcl::GeneralizedIterativeClosestPoint<Point, Point> registration;
  return align(pair, registration, false);
}

}  // namespace

std::vector<AlignPeer> pcl_align_peers() {
  return {
      {"PCL ICP", by_points}, {"PCL plane", by_planes}, {"PCL NDT", by_ndt}, {"PCL GICP", by_gicp}};
}

}  // namespace scan::test
