// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/poses.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "libscan/io/scan_file.h"
#include "libscan/io/shape_json.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

std::vector<NamedPose> random_poses() {
  std::vector<NamedPose> poses;
  RandomStream random(11, 0, 0);
  for (int i = 0; i < 50; ++i) {
    Vector6 twist;
    for (double& x : twist) x = random.normal();
    poses.push_back({std::to_string(i), exp(twist)});
  }
  return poses;
}

TEST(Poses, KittiAndMatricesComeBackToTheBit) {
  const TemporaryFolder folder;
  const auto poses = random_poses();
  write_poses_kitti(folder / "k.txt", poses);
  const auto back = read_poses(folder / "k.txt");
  ASSERT_EQ(back.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_EQ(back[i].pose.matrix(), poses[i].pose.matrix());
  for (const char* name : {"m.txt", "m.xf"}) {
    write_matrix(folder / name, poses[3].pose);
    ASSERT_EQ(read_poses(folder / name).size(), 1u);
    EXPECT_EQ(read_poses(folder / name)[0].pose.matrix(), poses[3].pose.matrix());
  }
}

// A rotation goes through a quaternion: some roundings of 1.1e-16 each, below 2e-15 together.
TEST(Poses, TumComesBackToRounding) {
  const TemporaryFolder folder;
  const auto poses = random_poses();
  write_poses_tum(folder / "p.tum", poses);
  const auto back = read_poses(folder / "p.tum");
  ASSERT_EQ(back.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(back[i].name, poses[i].name);
    EXPECT_EQ(back[i].pose.translation(), poses[i].pose.translation());
    EXPECT_LT((back[i].pose.linear() - poses[i].pose.linear()).norm(), 2e-15);
  }
}

TEST(Poses, TumFollowsItsConvention) {
  const TemporaryFolder folder;
  // a quarter turn about z carries x to y; the quaternion's last number is the scalar
  write_file(folder / "t.tum",
             "# t tx ty tz qx qy qz qw\n1.5 1 2 3 0 0 0.7071067811865476 0.7071067811865476\n");
  const auto poses = read_poses(folder / "t.tum");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].name, "1.5");
  EXPECT_LT((poses[0].pose * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm(), 1e-15);
}

TEST(Poses, ConfHoldsTheInverseRotation) {
  const TemporaryFolder folder;
  write_file(folder / "a.conf",
             "camera 0 0 0 0 0 0 1\nmesh ignored\nbmesh a.ply 1 2 3 0 0 0.7071067811865476 "
             "0.7071067811865476\n");
  const auto poses = read_poses(folder / "a.conf");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].name, "a.ply");
  EXPECT_LT((poses[0].pose * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 1, 3)).norm(), 1e-15);
}

TEST(Poses, AlignmentIsReadByFileName) {
  const TemporaryFolder folder;
  const Pose pose = random_poses()[7].pose;
  nlohmann::ordered_json document = {
      {"scans", {{{"file", "a.ply"}, {"world_from_scan", to_json(pose)}}}}};
  write_file(folder / "alignment.json", document.dump());
  const auto poses = read_poses(folder / "alignment.json");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].name, "a.ply");
  EXPECT_EQ(poses[0].pose.matrix(), pose.matrix());
}

TEST(Poses, NearRotationsAreProjectedFarOnesRefused) {
  const TemporaryFolder folder;
  write_file(folder / "near.txt", "1.0000005 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n");
  EXPECT_LT((read_poses(folder / "near.txt")[0].pose.linear() - Eigen::Matrix3d::Identity()).norm(),
            1e-15);
  write_file(folder / "far.txt", "1.000002 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n");
  EXPECT_NE(error_of([&] { read_poses(folder / "far.txt"); }).find("away from a rotation"),
            std::string::npos);
  write_file(folder / "mirror.txt", "-1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n");
  EXPECT_NE(error_of([&] { read_poses(folder / "mirror.txt"); }).find("left-handed"),
            std::string::npos);
  write_file(folder / "long.tum", "0 0 0 0 0 0 0 1.1\n");
  EXPECT_NE(error_of([&] { read_poses(folder / "long.tum"); }).find("quaternion's length is 1.1"),
            std::string::npos);
}

TEST(Poses, NameLineAndWordOfWhatIsBroken) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& name, const std::string& text) {
    write_file(folder / name, text);
    return error_of([&] { read_poses(folder / name); });
  };
  EXPECT_NE(said("a.tum", "0 0 0 0 0 0 0 1\n1 0 0 x 0 0 0 1\n").find("line 2, word 4: 'x'"),
            std::string::npos);
  EXPECT_NE(said("b.tum", "0 0 0 0 0 0 0 1\n1 0 0\n").find("line 2: has 3 numbers"),
            std::string::npos);
  EXPECT_NE(said("c.txt", "1 0 0 0\n0 1 0 0\n").find("ends inside a 4x4 matrix"),
            std::string::npos);
  EXPECT_NE(said("d.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n").find("last row"),
            std::string::npos);
  EXPECT_NE(said("e.txt", "").find("holds no pose"), std::string::npos);
  EXPECT_NE(said("f.txt", "1 2 3 4 5\n").find("has 5 words"), std::string::npos);
  EXPECT_NE(said("g.tum", "0 0 0 0 0 0 0 nan\n").find("not a finite number"), std::string::npos);
}

TEST(Poses, ReadsOrRefusesAnyDamage) {
  const TemporaryFolder folder;
  const auto poses = random_poses();
  write_poses_tum(folder / "p.tum", {poses[0], poses[1]});
  write_matrix(folder / "p.txt", poses[2].pose);
  for (const char* name : {"p.tum", "p.txt"})
    expect_read_or_refused(read_file(folder / name), 500, [&](const std::string& bytes) {
      write_file(folder / "damaged", bytes);
      for (const NamedPose& named : read_poses(folder / "damaged"))
        EXPECT_NEAR(named.pose.linear().determinant(), 1, 1e-9);
    });
}

// The convention of the data's README: with it every scan lies on the published surface, whose
// bounding box is known; with the other one most scans are tens of millimetres off.
TEST(RealData, BunnyConfPlacesTheScansOnTheBunny) {
  const auto folder = outside_data() / "stanford-bunny";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the Stanford bunny is not in " << folder;
  const auto poses = read_poses(folder / "data" / "bun.conf");
  ASSERT_EQ(poses.size(), 10u);
  const Bounds surface =
      bounds_of(read_mesh(folder / "reconstruction" / "bun_zipper.ply").vertices);
  const Bounds room(surface.min() - Eigen::Vector3d::Constant(0.003),
                    surface.max() + Eigen::Vector3d::Constant(0.003));
  for (const NamedPose& named : poses) {
    const PointCloud cloud = transformed(named.pose, read_scan(folder / "data" / named.name).cloud);
    std::size_t inside = 0;
    for (const auto& point : cloud.points) inside += room.contains(point);
    EXPECT_GT(static_cast<double>(inside), 0.99 * static_cast<double>(cloud.size())) << named.name;
  }
}

TEST(RealData, PublishedMatricesAndTrajectoriesRead) {
  const auto data = outside_data();
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "the outside data is not in " << data;
  const auto poses = read_poses(data / "lidar-small_gicp" / "T_target_source.txt");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_NEAR(poses[0].pose.translation().x(), 0.488882, 1e-12);
  EXPECT_EQ(read_poses(data / "redwood-rgbd" / "odometry.log").size(), 5u);
}

}  // namespace
}  // namespace scan
