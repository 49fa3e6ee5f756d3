// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The ten range scans of the Stanford bunny, from disturbed poses back to the published ones.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "libscan/align/multiview.h"
#include "libscan/align/rigid_fit.h"
#include "tests/align/test_clouds.h"

namespace scan {
namespace {

namespace fs = std::filesystem;
const fs::path folder = fs::path(LIBSCAN_SOURCE_DIR) / "../shared/data/stanford-bunny/data";

// The vertices of an ASCII range image; its range_grid is not needed.
PointCloud read_vertices(const fs::path& path) {
  std::ifstream file(path);
  std::size_t count = 0;
  for (std::string line; std::getline(file, line) && line.substr(0, 10) != "end_header";) {
    std::istringstream words(line);
    std::string element, name;
    if (words >> element >> name && element == "element" && name == "vertex") words >> count;
  }
  PointCloud cloud;
  cloud.points.resize(count);
  for (Eigen::Vector3d& x : cloud.points) file >> x.x() >> x.y() >> x.z();
  EXPECT_TRUE(file) << path;
  return cloud;
}

struct Bunny {
  std::vector<std::string> names;
  std::vector<PointCloud> clouds;
  std::vector<Pose> published;
};

// Lines `bmesh FILE tx ty tz qx qy qz qw`; the stored quaternion is the inverse rotation.
Bunny read_bunny() {
  Bunny bunny;
  std::ifstream conf(folder / "bun.conf");
  for (std::string line; std::getline(conf, line);) {
    std::istringstream words(line);
    std::string kind, name;
    Eigen::Vector3d t;
    double x, y, z, w;
    words >> kind >> name >> t.x() >> t.y() >> t.z() >> x >> y >> z >> w;
    if (kind != "bmesh") continue;
    const Eigen::Quaterniond q(w, x, y, z);
    bunny.names.push_back(name);
    bunny.published.push_back(make_pose(q.normalized().toRotationMatrix().transpose(), t));
    bunny.clouds.push_back(read_vertices(folder / name));
    // The sensor looks along -z of the scan's frame.
    test::estimate_normals(bunny.clouds.back(),
                           [](const Eigen::Vector3d&) { return Eigen::Vector3d::UnitZ().eval(); });
  }
  return bunny;
}

// Per scan: rms distance of its points from where the published pose puts them, after the one rigid
// motion that brings all scans together nearest to the published poses (the world's frame is free).
std::vector<double> rms_from_published_m(const Bunny& bunny, const std::vector<Pose>& poses) {
  std::vector<Eigen::Vector3d> mine, published;
  for (std::size_t i = 0; i < poses.size(); ++i)
    for (std::size_t k = 0; k < bunny.clouds[i].size(); k += 10) {
      mine.push_back(poses[i] * bunny.clouds[i].points[k]);
      published.push_back(bunny.published[i] * bunny.clouds[i].points[k]);
    }
  const Pose common = rigid_fit(mine, published).target_from_source;
  std::vector<double> rms_m;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    double sum = 0;
    for (const Eigen::Vector3d& x : bunny.clouds[i].points)
      sum += (common * (poses[i] * x) - bunny.published[i] * x).squaredNorm();
    rms_m.push_back(std::sqrt(sum / double(bunny.clouds[i].size())));
  }
  return rms_m;
}

// A turn about the scan's own centre, so that 5 degrees move its points by 5 degrees times their
// distance from it and the shift is 5 mm.
std::vector<Pose> disturbed(const Bunny& bunny, std::uint64_t seed) {
  std::vector<Pose> guesses;
  for (std::size_t i = 0; i < bunny.clouds.size(); ++i) {
    RandomStream random(seed, std::uint32_t(i), 0);
    const Eigen::Vector3d centre = bunny.published[i] * bounds_of(bunny.clouds[i].points).center();
    const Pose motion = test::random_pose(random, rad_from_deg(5), 5e-3);
    guesses.push_back(Eigen::Translation3d(centre) * motion * Eigen::Translation3d(-centre) *
                      bunny.published[i]);
  }
  return guesses;
}

TEST(Bunny, TenScansReturnToTheirPublishedPoses) {
  if (!fs::exists(folder / "bun.conf"))
    GTEST_SKIP() << "the Stanford bunny scans are not at " << folder;
  const Bunny bunny = read_bunny();
  ASSERT_EQ(bunny.clouds.size(), 10u);
  const MultiviewResult result = align_scans(bunny.clouds, disturbed(bunny, 1));
  EXPECT_EQ(result.stop, Stop::converged);
  std::vector<Pose> poses;
  for (const ScanPose& scan : result.scans) poses.push_back(scan.world_from_scan);
  // The published poses are themselves known to 0.2 to 0.3 mm; half a millimetre is one sample
  // spacing of the scanner.
  const std::vector<double> rms_m = rms_from_published_m(bunny, poses);
  for (std::size_t i = 0; i < rms_m.size(); ++i) {
    RecordProperty(bunny.names[i] + "_rms_um", static_cast<int>(1e6 * rms_m[i]));
    EXPECT_LT(rms_m[i], 0.5e-3) << bunny.names[i];
  }
}

}  // namespace
}  // namespace scan
