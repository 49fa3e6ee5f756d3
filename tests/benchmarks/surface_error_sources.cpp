// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Whether the surface of a run knows its own uncertainty, source by source: what the true errors of
// the poses and of the points move each vertex by, and what is left, each beside its stated
// variance: root mean squares in um, the mean of their squared ratio and that of its median to a
// normal variable's (1 is honest), and the share inside the 95 % interval. The anchor, scan 0, is
// held to be right; unsupported vertices and those of unknown poses do not count.
//
// surface_error_sources RUN [most depth of the octree]
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "libscan/core/median.h"
#include "libscan/io/truth_file.h"
#include "libscan/reconstruct/reconstruct.h"
#include "libscan/reconstruct/surface_uncertainty.h"
#include "libscan/reconstruct/surface_weights.h"
#include "libscan/verify/surface_error.h"
#include "tools/run_files.h"

namespace scan {
namespace {

class Source {
 public:
  void add(double error_m, double variance_m2) {
    error_m2_ += error_m * error_m, stated_m2_ += variance_m2;
    ratios_.push_back(error_m * error_m / variance_m2);
  }
  void print(const char* name) const {
    const auto count = static_cast<double>(ratios_.size());
    double ratio = 0, inside = 0;
    for (const double one : ratios_) ratio += one, inside += one <= 3.841458820694124;
    std::printf("  %-14s rms %9.2f, stated %9.2f, ratio %7.3f, by medians %7.3f, inside %6.2f %%\n",
                name, 1e6 * std::sqrt(error_m2_ / count), 1e6 * std::sqrt(stated_m2_ / count),
                ratio / count, median(ratios_) / 0.454936423119572, 100 * inside / count);
  }

 private:
  double error_m2_ = 0, stated_m2_ = 0;
  std::vector<double> ratios_;
};

struct Run {
  PointCloud cloud;  // world
  std::vector<Eigen::Vector3d> viewpoints;
  std::vector<Eigen::Vector3d> at_truth;  // the points by their scans' true poses
  CommonErrors common;
  Truth truth;
  Pose truth_from_world;  // by the anchor
};

Run read(const std::filesystem::path& folder) {
  const std::vector<Scan> scans = read_run_scans(folder);
  const std::vector<Pose> poses = read_run_poses(folder);
  Run run{.cloud = transformed(poses.front(), scans.front().cloud),
          .viewpoints = {},
          .at_truth = {},
          .common = common_errors(scans, read_run_stated_poses(folder)),
          .truth = read_truth(truth_path(folder)),
          .truth_from_world = Pose::Identity()};
  run.truth_from_world = run.truth.scans[0].world_from_scanner * poses[0].inverse();
  for (std::size_t s = 0; s < scans.size(); ++s) {
    if (s > 0) append(run.cloud, transformed(poses[s], scans[s].cloud));
    run.viewpoints.insert(run.viewpoints.end(), scans[s].cloud.size(),
                          poses[s] * scans[s].viewpoint);
    for (const Eigen::Vector3d& x : scans[s].cloud.points)
      run.at_truth.push_back(run.truth.scans[s].world_from_scanner * x);
  }
  return run;
}

void study(const std::filesystem::path& folder, int depth) {
  const Run run = read(folder);
  const SurfaceResult result = reconstruct(run.cloud, run.viewpoints, {.ssd = {.depth = depth}});
  const SurfaceWeights weights(result.surface, result.vertex_smoothing_m, run.cloud);
  const auto variances = surface_variances(result, run.cloud, run.common);
  const Mesh moved = transformed(run.truth_from_world, result.surface);
  const auto normals = vertex_normals(moved);
  const auto deviations = deviations_m(moved.vertices, run.truth.surface);
  const auto point_errors = deviations_m(run.at_truth, run.truth.surface);
  Source all, posed_right, poses, points, rest;
  for (std::size_t v = 0; v < deviations.size(); ++v) {
    const SurfaceVariance& stated = variances[v];
    if (!(result.support_m[v] <= supported_within_spacings * result.data_spacing_m[v])) continue;
    if (!std::isfinite(stated.poses_m2)) continue;
    double by_poses = 0, by_points = 0;
    for (const auto& [i, weight] : weights.at(v)) {
      by_poses +=
          weight * normals[v].dot(run.truth_from_world * run.cloud.points[i] - run.at_truth[i]);
      by_points += weight * point_errors[i];
    }
    all.add(deviations[v], stated.total_m2());
    posed_right.add(deviations[v] - by_poses, stated.points_m2 + stated.smoothing_m2);
    if (stated.poses_m2 > 0) poses.add(by_poses, stated.poses_m2);
    points.add(by_points, stated.points_m2);
    rest.add(deviations[v] - by_poses - by_points, stated.smoothing_m2);
  }
  std::printf("%s\n", folder.c_str());
  all.print("all");
  posed_right.print("without poses");
  poses.print("poses");
  points.print("points");
  rest.print("smoothing");
}

}  // namespace
}  // namespace scan

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "surface_error_sources RUN [most depth of the octree]\n");
    return 2;
  }
  scan::study(argv[1], argc > 2 ? std::atoi(argv[2]) : scan::SsdOptions{}.depth);
}
