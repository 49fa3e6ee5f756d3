// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Time and error of pairwise alignment, libscan's methods beside PCL's, on pairs whose pose is
// known exactly and on two real pairs; and libscan's time against points and threads.
//
// align_benchmark [threads] [overlap ...]; without arguments 1 thread and overlaps 0.7 0.5 0.3.
// Thinning is the same for all and not in the times. `prepare`: tree and normals of both clouds
// (PCL computes GICP's covariances within the alignment). Medians of five runs.
#define PCL_NO_PRECOMPILE
#include <pcl/features/normal_3d.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ndt.h>
#include <pcl/search/kdtree.h>

#include <cstdio>
#include <cstdlib>
#include <functional>

#include "libscan/align/icp.h"
#include "libscan/core/cost.h"
#include "libscan/core/parallel.h"
#include "tests/benchmarks/split_pairs.h"

namespace scan::test {
namespace {

constexpr int runs = 5;

struct Outcome {
  double prepare_s = 0, align_s = 0;
  Pose pose = Pose::Identity();
  std::string stop;
};

Outcome median_of(const std::function<Outcome()>& run) {
  std::vector<double> prepare_s, align_s;
  Outcome outcome;
  for (int i = 0; i < runs; ++i) {
    outcome = run();
    prepare_s.push_back(outcome.prepare_s);
    align_s.push_back(outcome.align_s);
  }
  std::sort(prepare_s.begin(), prepare_s.end());
  std::sort(align_s.begin(), align_s.end());
  outcome.prepare_s = prepare_s[runs / 2];
  outcome.align_s = align_s[runs / 2];
  return outcome;
}

Outcome by_libscan(const PairCase& pair, IcpMethod method) {
  Outcome outcome;
  const Stopwatch watch;
  const PreparedCloud source = prepare(pair.source), target = prepare(pair.target);
  outcome.prepare_s = watch.seconds();
  const IcpResult result = icp(source, target, pair.guess, {.method = method});
  outcome.align_s = watch.seconds() - outcome.prepare_s;
  outcome.pose = result.target_from_source;
  outcome.stop = name_of(result.stop);
  return outcome;
}

using PclPoint = pcl::PointNormal;
using PclCloud = pcl::PointCloud<PclPoint>;

PclCloud::Ptr pcl_cloud(const PointCloud& cloud) {
  auto made = std::make_shared<PclCloud>();
  for (const Eigen::Vector3d& x : cloud.points) {
    PclPoint point;
    point.getVector3fMap() = x.cast<float>();
    made->push_back(point);
  }
  return made;
}

void add_pcl_normals(const PclCloud::Ptr& cloud) {
  pcl::NormalEstimation<PclPoint, PclPoint> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<PclPoint>>());
  estimation.setKSearch(20);
  estimation.compute(*cloud);
}

// The settings of the published comparison: 1e-4 rad and 1e-4 of the unit, 100 iterations.
template <class Registration>
Outcome by_pcl(const PairCase& pair, Registration& registration, bool normals) {
  Outcome outcome;
  const PclCloud::Ptr source = pcl_cloud(pair.source), target = pcl_cloud(pair.target);
  const Stopwatch watch;
  if (normals) add_pcl_normals(source), add_pcl_normals(target);
  outcome.prepare_s = watch.seconds();
  registration.setInputSource(source);
  registration.setInputTarget(target);
  registration.setMaxCorrespondenceDistance(pair.reach_m);
  registration.setMaximumIterations(100);
  registration.setTransformationEpsilon(1e-8);
  registration.setTransformationRotationEpsilon(1 - 0.5e-8);
  PclCloud moved;
  registration.align(moved, pair.guess.matrix().cast<float>());
  outcome.align_s = watch.seconds() - outcome.prepare_s;
  outcome.pose.matrix() = registration.getFinalTransformation().template cast<double>();
  outcome.stop = registration.hasConverged() ? "converged" : "not converged";
  return outcome;
}

Outcome pcl_icp(const PairCase& pair) {
  pcl::IterativeClosestPoint<PclPoint, PclPoint> registration;
  return by_pcl(pair, registration, false);
}

Outcome pcl_plane(const PairCase& pair) {
  pcl::IterativeClosestPointWithNormals<PclPoint, PclPoint> registration;
  return by_pcl(pair, registration, true);
}

Outcome pcl_ndt(const PairCase& pair) {
  pcl::NormalDistributionsTransform<PclPoint, PclPoint> registration;
  registration.setResolution(static_cast<float>(pair.step_m));
  registration.setStepSize(0.1 * pair.step_m);
  return by_pcl(pair, registration, false);
}

Outcome pcl_gicp(const PairCase& pair) {
  pcl::GeneralizedIterativeClosestPoint<PclPoint, PclPoint> registration;
  return by_pcl(pair, registration, false);
}

void print(const PairCase& pair, const std::string& method, const Outcome& outcome,
           double reference_s) {
  const Eigen::Vector3d centre = centroid(pair.source);
  const double total_s = outcome.prepare_s + outcome.align_s;
  std::printf("%-9s %-20s %9.1f %9.1f %9.1f %8.3f  %9.5f  %10.3g  %s\n", pair.name.c_str(),
              method.c_str(), 1e3 * outcome.prepare_s, 1e3 * outcome.align_s, 1e3 * total_s,
              total_s / reference_s, deg_from_rad(rotation_distance_rad(outcome.pose, pair.truth)),
              (outcome.pose * centre - pair.truth * centre).norm(), outcome.stop.c_str());
  std::fflush(stdout);
}

void compare(const PairCase& pair) {
  std::printf("\n%s: %zu on %zu points\n", pair.name.c_str(), pair.source.size(),
              pair.target.size());
  const Outcome reference = median_of([&] { return pcl_gicp(pair); });
  const double reference_s = reference.prepare_s + reference.align_s;
  for (const IcpMethod method : {IcpMethod::point_to_point, IcpMethod::point_to_plane,
                                 IcpMethod::symmetric, IcpMethod::plane_to_plane})
    print(pair, std::string(name_of(method)), median_of([&] { return by_libscan(pair, method); }),
          reference_s);
  print(pair, "PCL ICP", median_of([&] { return pcl_icp(pair); }), reference_s);
  print(pair, "PCL plane", median_of([&] { return pcl_plane(pair); }), reference_s);
  print(pair, "PCL NDT", median_of([&] { return pcl_ndt(pair); }), reference_s);
  print(pair, "PCL GICP", reference, reference_s);
}

// Log-log slope of the whole time against points.
void scaling() {
  std::printf("\nwaves of n points, split in two:   prepare s   align s\n");
  double last_s = 0;
  for (const std::size_t n : {10'000u, 100'000u, 1'000'000u, 10'000'000u}) {
    PointCloud cloud;
    for (std::size_t i = 0; i < n; ++i) {
      RandomStream random(1, 2, i);
      const double x = 2 * random.uniform() - 1, y = 2 * random.uniform() - 1;
      cloud.points.emplace_back(x, y, 0.2 * std::sin(5 * x) * std::cos(4 * y) + 0.1 * x * y);
    }
    const PairCase pair = split_pair("waves", cloud, {.noise_m = 1e-4, .start_m = 0.01}, 1);
    const Outcome outcome = by_libscan(pair, IcpMethod::symmetric);
    const double total_s = outcome.prepare_s + outcome.align_s;
    std::printf("%10zu                        %9.3f %9.3f", n, outcome.prepare_s, outcome.align_s);
    if (last_s > 0) std::printf("   slope %.3f", std::log10(total_s / last_s));
    std::printf("\n");
    std::fflush(stdout);
    last_s = total_s;
  }
}

std::vector<PairCase> real_pairs() {
  std::vector<PairCase> pairs;
  const auto data = shared_data();
  PairCase bunny{.name = "bun45"};
  const auto poses = read_poses(data / "stanford-bunny/data/bun.conf");
  bunny.target = points_of(data / "stanford-bunny/data/bun000.ply");
  bunny.source = points_of(data / "stanford-bunny/data/bun045.ply");
  Pose world_from[2];
  for (const NamedPose& pose : poses) {
    if (pose.name == "bun000.ply") world_from[0] = pose.pose;
    if (pose.name == "bun045.ply") world_from[1] = pose.pose;
  }
  bunny.truth = world_from[0].inverse() * world_from[1];
  RandomStream random(1, 3, 0);
  const Eigen::Vector3d centre = centroid(bunny.source);
  bunny.guess = bunny.truth * Eigen::Translation3d(centre) * random_motion(random, 5, 5e-3) *
                Eigen::Translation3d(-centre);
  bunny.reach_m = bunny.step_m = 0.01;
  pairs.push_back(bunny);
  PairCase lidar{.name = "lidar2"};
  lidar.target = voxel_grid(points_of(data / "lidar-small_gicp/target.ply"), 0.25);
  lidar.source = voxel_grid(points_of(data / "lidar-small_gicp/source.ply"), 0.25);
  lidar.truth = read_poses(data / "lidar-small_gicp/T_target_source.txt").front().pose;
  lidar.reach_m = lidar.step_m = 1;
  pairs.push_back(lidar);
  return pairs;
}

}  // namespace
}  // namespace scan::test

int main(int argc, char** argv) {
  using namespace scan::test;
  const scan::ThreadLimit limit(argc > 1 ? std::atoi(argv[1]) : 1);
  std::vector<double> overlaps;
  for (int i = 2; i < argc; ++i) overlaps.push_back(std::atof(argv[i]));
  if (overlaps.empty()) overlaps = {0.7, 0.5, 0.3};
  std::printf(
      "pair      method              prepare ms  align ms  total ms  / GICP  turn deg"
      "   centroid m\n");
  for (const double overlap : overlaps) {
    std::printf("\noverlap %.0f %%\n", 100 * overlap);
    for (const PairCase& pair : split_pairs(overlap, 1)) compare(pair);
  }
  std::printf("\nreal pairs, against published poses worth 0.3 mm and 2 cm\n");
  for (const PairCase& pair : real_pairs()) compare(pair);
  scaling();
  return 0;
}
