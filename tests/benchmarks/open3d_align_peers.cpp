// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/align_peers.h"

#ifdef LIBSCAN_OPEN3D

#include <omp.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/pipelines/registration/GeneralizedICP.h>
#include <open3d/pipelines/registration/Registration.h>

#include <cstdlib>

namespace scan::test {
namespace {

using open3d::geometry::PointCloud;
namespace registration = open3d::pipelines::registration;

constexpr int neighbours = 20;  // as in the published comparison

std::shared_ptr<PointCloud> thinned(const PointCloud& cloud, double side_m) {
  return side_m > 0 ? cloud.VoxelDownSample(side_m) : std::make_shared<PointCloud>(cloud);
}

// run(source, target): Open3D's own stop at 1e-6 of fitness and rmse, 100 iterations.
template <class Run>
Outcome align(const PairCase& pair, bool normals, Run&& run) {
  Outcome outcome;
  const PointCloud whole_source(pair.source.points), whole_target(pair.target.points);
  const PairWatch watch;
  const auto source = thinned(whole_source, pair.thin_m);
  const auto target = thinned(whole_target, pair.thin_m);
  if (normals)
    for (const auto& cloud : {source, target})
      cloud->EstimateNormals(open3d::geometry::KDTreeSearchParamKNN(neighbours));
  outcome.prepare_s = watch.seconds();
  const registration::RegistrationResult result = run(*source, *target);
  outcome.align_s = watch.seconds() - outcome.prepare_s;
  outcome.pose.matrix() = result.transformation_;
  outcome.stop = "(does not say)";
  return outcome;
}

const registration::ICPConvergenceCriteria criteria(1e-6, 1e-6, 100);

Outcome by_points(const PairCase& pair) {
  return align(pair, false, [&](const PointCloud& source, const PointCloud& target) {
    return registration::RegistrationICP(source, target, pair.reach_m, pair.guess.matrix(),
                                         registration::TransformationEstimationPointToPoint(),
                                         criteria);
  });
}

Outcome by_planes(const PairCase& pair) {
  return align(pair, true, [&](const PointCloud& source, const PointCloud& target) {
    return registration::RegistrationICP(source, target, pair.reach_m, pair.guess.matrix(),
                                         registration::TransformationEstimationPointToPlane(),
                                         criteria);
  });
}

// It makes its covariances of the normals, within the alignment.
Outcome by_gicp(const PairCase& pair) {
  return align(pair, true, [&](const PointCloud& source, const PointCloud& target) {
    return registration::RegistrationGeneralizedICP(
        source, target, pair.reach_m, pair.guess.matrix(),
        registration::TransformationEstimationForGeneralizedICP(), criteria);
  });
}

}  // namespace

std::vector<AlignPeer> open3d_align_peers(int threads) {
  setenv("OMP_NUM_THREADS", std::to_string(threads).c_str(), 1);  // some of it looks there
  omp_set_num_threads(threads);
  return {{"Open3D points", by_points}, {"Open3D plane", by_planes}, {"Open3D GICP", by_gicp}};
}

}  // namespace scan::test

#else

namespace scan::test {

std::vector<AlignPeer> open3d_align_peers(int) {
  return {};
}

}  // namespace scan::test

#endif
