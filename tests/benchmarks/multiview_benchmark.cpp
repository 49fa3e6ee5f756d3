// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Many scans into one frame: errors, seconds and memory on long paths, simulated full turns and the
// ten bunny scans.
//
//   multiview_benchmark [DATA]   DATA: the folder that holds stanford-bunny
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>

#include "libscan/acquire/normals.h"
#include "libscan/align/multiview.h"
#include "libscan/align/pose_graph.h"
#include "libscan/core/parallel.h"
#include "libscan/core/random.h"
#include "libscan/core/units.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"
#include "libscan/verify/pose_error.h"
#include "tests/align/simulated_path.h"
#include "tests/align/turntable.h"

namespace scan {
namespace {

struct Views {
  std::vector<std::string> names;
  std::vector<PointCloud> clouds;
  std::vector<Pose> truth;
};

Views read_bunny(const std::filesystem::path& folder) {
  Views views;
  for (const NamedPose& named : read_poses(folder / "bun.conf")) {
    Scan scan = read_scan(folder / named.name);
    if (scan.cloud.normals.empty()) estimate_normals(scan);
    views.names.push_back(named.name);
    views.clouds.push_back(std::move(scan.cloud));
    views.truth.push_back(named.pose);
  }
  return views;
}

// Turned about the middle of the scan and shifted, in random directions; the first stays.
std::vector<Pose> disturbed(const Views& views, double angle_rad, double shift_m,
                            std::uint64_t seed) {
  std::vector<Pose> guesses = views.truth;
  for (std::size_t i = 1; i < guesses.size(); ++i) {
    RandomStream random(seed, std::uint32_t(i), 0);
    const Eigen::Vector3d centre = guesses[i] * bounds_of(views.clouds[i].points).center();
    const Pose off = test::random_pose(random, angle_rad, shift_m);
    guesses[i] = Eigen::Translation3d(centre) * off * Eigen::Translation3d(-centre) * guesses[i];
  }
  return guesses;
}

void tell(const Views& views, const MultiviewResult& result, bool each_scan) {
  std::vector<Pose> found;
  std::vector<std::vector<Eigen::Vector3d>> points;
  for (const ScanPose& scan : result.scans) found.push_back(scan.world_from_scan);
  for (const PointCloud& cloud : views.clouds) points.push_back(cloud.points);
  const auto errors = pose_errors(found, views.truth, points);
  double worst_m = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    worst_m = std::max(worst_m, errors[i].moved_points_rms_m);
    if (!each_scan) continue;
    const ScanPose& scan = result.scans[i];
    double sigma_m = 0, sigma_rad = 0;
    if (scan.covariance) {
      sigma_rad = std::sqrt(scan.covariance->topLeftCorner<3, 3>().trace());
      sigma_m = std::sqrt(scan.covariance->bottomRightCorner<3, 3>().trace());
    }
    std::printf("  %-14s %8.3f mm %8.3f deg  sigma %6.3f mm %6.3f deg  agreement %.3f  %s\n",
                views.names[i].c_str(), 1e3 * errors[i].moved_points_rms_m,
                deg_from_rad(errors[i].rotation_rad), 1e3 * sigma_m, deg_from_rad(sigma_rad),
                scan.agreement, std::string(name_of(scan.stop)).c_str());
  }
  std::size_t accepted = 0;
  for (const ScanEdge& edge : result.edges) accepted += edge.accepted;
  std::printf(
      "  worst %.3f mm; %s; %zu of %zu pairs accepted, %zu joint, %d rounds; %.2f s; %.0f "
      "MiB at most so far\n",
      1e3 * worst_m, std::string(name_of(result.stop)).c_str(), accepted, result.edges.size(),
      result.pairs_used, result.rounds, result.cost.seconds, peak_memory_mib());
}

void bunny(const std::filesystem::path& folder) {
  const Views views = read_bunny(folder);
  const auto try_with = [&](double degrees, double mm, std::uint64_t seed, bool each_scan) {
    std::printf("bunny, guesses off by %g deg and %g mm, seed %d\n", degrees, mm, int(seed));
    tell(views, align_scans(views.clouds, disturbed(views, rad_from_deg(degrees), 1e-3 * mm, seed)),
         each_scan);
  };
  try_with(5, 5, 1, true);
  try_with(8, 8, 1, true);
  for (std::uint64_t seed = 2; seed <= 5; ++seed) try_with(8, 8, seed, false);
}

// What is left when the poses of neighbours are chained around the turn, none for poses in one
// frame, and how far off the worst of them moves its scan's middle.
void tell_loop(const char* name, const std::vector<Pose>& to_next, const std::vector<Pose>& truth,
               const std::vector<PointCloud>& clouds) {
  Pose loop = Pose::Identity();
  double worst_m = 0;
  for (std::size_t i = 0; i < to_next.size(); ++i) {
    loop = loop * to_next[i];
    const Eigen::Vector3d middle = bounds_of(clouds[(i + 1) % clouds.size()].points).center();
    worst_m = std::max(worst_m, (to_next[i] * middle - truth[i] * middle).norm());
  }
  std::printf("  %-16s loop error %8.4f deg %8.4f mm, worst link %.3f mm\n", name,
              deg_from_rad(rotation_distance_rad(loop, Pose::Identity())),
              1e3 * loop.translation().norm(), 1e3 * worst_m);
}

void full_turn(int scans) {
  std::printf(
      "full turn of %d scans, a lump of 1 m radius, noise 1 mm, guesses off by 3 deg and 40 mm\n",
      scans);
  test::Turntable turn = test::turntable(scans, 0.001);
  Views views{{}, std::move(turn.clouds), std::move(turn.truth)};
  for (std::size_t i = 0; i < views.clouds.size(); ++i) views.names.push_back(std::to_string(i));
  const MultiviewResult result = align_scans(views.clouds, turn.guesses);
  std::vector<Pose> chain, joint, truth;
  for (std::size_t i = 0; i < views.clouds.size(); ++i) {
    const std::size_t next = (i + 1) % views.clouds.size();
    const auto relative = [&](const std::vector<Pose>& poses) {
      return Pose(poses[i].inverse() * poses[next]);
    };
    truth.push_back(relative(views.truth));
    chain.push_back(
        icp(views.clouds[next], views.clouds[i], relative(turn.guesses)).target_from_source);
    joint.push_back(result.scans[i].world_from_scan.inverse() * result.scans[next].world_from_scan);
  }
  tell_loop("chain of pairs", chain, truth, views.clouds);
  tell_loop("joint poses", joint, truth, views.clouds);
  tell(views, result, false);
}

// Squares of 2 m of 30 x 30 points in a row, 0.8 m apart: each meets two others on either side.
void long_path(std::size_t scans) {
  const test::SimulatedViews path =
      test::simulated_path(test::ScannerNoise::lidar, scans, 30, 0.8, 1);
  const MultiviewResult result = align_scans(path.clouds, path.guesses);
  std::size_t tied = 0;
  for (const ScanPose& scan : result.scans)
    tied += scan.stop == Stop::converged || scan.stop == Stop::degenerate;
  const test::LinkErrors errors = test::link_errors(result, path.truth);
  std::printf(
      "path of %4zu scans: %4zu tied, link errors e^T I e / 6 %.2f, %2d rounds, %6.2f s, %5.0f MiB "
      "at most so far\n",
      scans, tied, errors.mean, result.rounds, result.cost.seconds, peak_memory_mib());
}

}  // namespace
}  // namespace scan

int main(int count, char** arguments) {
  for (const std::size_t scans : {100, 300, 1000}) scan::long_path(scans);
  for (const int scans : {24, 36}) scan::full_turn(scans);
  const std::filesystem::path data =
      count > 1 ? arguments[1] : LIBSCAN_SOURCE_DIR "/../shared/data";
  if (std::filesystem::exists(data / "stanford-bunny/data/bun.conf"))
    scan::bunny(data / "stanford-bunny/data");
  return 0;
}
