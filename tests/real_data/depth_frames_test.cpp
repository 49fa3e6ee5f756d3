// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Five depth frames of a hand-held camera (Redwood): 16-bit PNG in millimetres, to scans, to poses.
#include "libscan/core/camera.h"
#include "libscan/core/units.h"
#include "libscan/io/image_file.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"
#include "libscan/verify/pose_error.h"
#include "tests/real_data/real_data.h"

namespace scan::test {
namespace {

const fs::path folder = data_folder("redwood-rgbd");
constexpr int step_px = 4;  // every fourth pixel both ways: 19,200 rays

Image<std::uint16_t> depth_mm(int frame) {
  return read_grey16(folder / "depth" / ("0000" + std::to_string(frame) + ".png"));
}

// camera_primesense.json: focal length 525 px, principal point (319.5, 239.5).
Scan scan_of(const Image<std::uint16_t>& depth) {
  Scan scan;
  scan.grid = {std::uint32_t(depth.height / step_px), std::uint32_t(depth.width / step_px)};
  for (std::uint32_t row = 0; row < scan.grid.rows; ++row)
    for (std::uint32_t column = 0; column < scan.grid.columns; ++column) {
      const int u = int(column) * step_px, v = int(row) * step_px;
      const double z_m = 1e-3 * depth(u, v);
      if (z_m == 0) {
        ++scan.misses["no signal"];
        continue;
      }
      scan.cloud.points.emplace_back(z_m * (u - 319.5) / 525, z_m * (v - 239.5) / 525, z_m);
      scan.ray.push_back(row * scan.grid.columns + column);
    }
  return scan;
}

TEST(DepthFrames, HoldMillimetresInSixteenBits) {
  SKIP_WITHOUT(folder);
  for (int frame = 0; frame < 5; ++frame) {
    const Image<std::uint16_t> depth = depth_mm(frame);
    EXPECT_EQ(depth.width, 640);
    EXPECT_EQ(depth.height, 480);
    int nearest = 65535, farthest = 0;
    for (const int value : depth.pixels)
      if (value > 0) nearest = std::min(nearest, value), farthest = std::max(farthest, value);
    // 0.96 to 2.70 m, as the data's description says: bytes swapped, or cut to 8 bits, would not be
    EXPECT_GE(nearest, 955);
    EXPECT_LE(farthest, 2705);
  }
}

// The camera moves 10 cm in all; every frame starts where the first one is. A frame carried into
// another by the published poses differs by 5 mm in the median: that is what they are worth.
TEST(DepthFrames, ReturnToTheirPublishedPosesFromIdentity) {
  SKIP_WITHOUT(folder);
  const Folder out;
  std::vector<std::string> arguments{"align"};
  std::vector<std::vector<Eigen::Vector3d>> points;
  for (int frame = 0; frame < 5; ++frame) {
    const Scan scan = scan_of(depth_mm(frame));
    const fs::path file = out / (std::to_string(frame) + ".ply");
    write_scan(file, scan);
    arguments.push_back(file.string());
    points.push_back(scan.cloud.points);
  }
  arguments.push_back((out / "aligned").string());
  const Answer aligned = ask_scan(arguments);
  ASSERT_EQ(aligned.exit_code, 0) << aligned.err;
  print_seconds(aligned);

  std::vector<Pose> found, start, published;
  for (const NamedPose& scan : read_poses(out / "aligned/alignment.json"))
    found.push_back(scan.pose);
  for (const NamedPose& frame : read_poses(folder / "odometry.log"))
    published.push_back(frame.pose);
  start.resize(published.size(), Pose::Identity());
  ASSERT_EQ(found.size(), published.size());
  const auto before = pose_errors(start, published, points);
  const auto after = pose_errors(found, published, points);
  for (std::size_t i = 0; i < after.size(); ++i) {
    std::cout << "  frame " << i << ": " << aligned.json.at("scans").at(i).at("stop") << ", "
              << 1e3 * before[i].moved_points_rms_m << " mm rms before, "
              << 1e3 * after[i].moved_points_rms_m << " mm after, "
              << deg_from_rad(after[i].rotation_rad) << " deg\n";
    EXPECT_LT(after[i].moved_points_rms_m, 5e-3) << "frame " << i;
  }
}

}  // namespace
}  // namespace scan::test
