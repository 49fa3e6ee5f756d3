// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/pcl_prerejective.h"

#include <pcl/features/fpfh.h>
#include <pcl/point_types.h>
#include <pcl/registration/sample_consensus_prerejective.h>

namespace scan {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Histograms = pcl::PointCloud<pcl::FPFHSignature33>;

Cloud::Ptr cloud_of(const ScanFeatures& features) {
  const auto cloud = std::make_shared<Cloud>();
  for (std::size_t i = 0; i < features.cloud.size(); ++i) {
    pcl::PointNormal point;
    point.getVector3fMap() = features.cloud.points[i].cast<float>();
    point.getNormalVector3fMap() = features.cloud.normals[i].cast<float>();
    cloud->push_back(point);
  }
  return cloud;
}

Histograms::Ptr histograms_of(const Cloud::Ptr& cloud, double radius_m) {
  pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(cloud);
  estimation.setRadiusSearch(radius_m);
  const auto histograms = std::make_shared<Histograms>();
  estimation.compute(*histograms);
  return histograms;
}

}  // namespace

std::optional<Pose> pcl_prerejective(const ScanFeatures& source, const ScanFeatures& target) {
  const Cloud::Ptr from = cloud_of(source), to = cloud_of(target);
  pcl::SampleConsensusPrerejective<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> align;
  align.setInputSource(from);
  align.setSourceFeatures(histograms_of(from, 5 * source.side_m));
  align.setInputTarget(to);
  align.setTargetFeatures(histograms_of(to, 5 * target.side_m));
  align.setMaximumIterations(50000);
  align.setNumberOfSamples(3);
  align.setCorrespondenceRandomness(5);
  align.setSimilarityThreshold(0.9f);
  align.setMaxCorrespondenceDistance(2.5 * source.side_m);
  align.setInlierFraction(0.25f);
  Cloud moved;
  align.align(moved);
  if (!align.hasConverged()) return std::nullopt;
  return Pose(align.getFinalTransformation().cast<double>());
}

}  // namespace scan
