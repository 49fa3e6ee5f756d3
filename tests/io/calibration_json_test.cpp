// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/calibration_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "libscan/io/json_output.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

const Camera camera = {640, 480, 800.125, 799.7, 318.5, 241.5, -0.11, 0.03, 1e-4, 2e-5, 3e-6};

// Symmetric, no two entries alike.
template <int Size>
Eigen::Matrix<double, Size, Size> covariance() {
  Eigen::Matrix<double, Size, Size> matrix;
  for (int i = 0; i < Size; ++i)
    for (int k = 0; k < Size; ++k)
      matrix(i, k) = 1.0 / 3 / (1 + std::max(i, k) + 100.0 * std::min(i, k));
  return matrix;
}

bool same(const Camera& a, const Camera& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && a.fx_px == b.fx_px &&
         a.fy_px == b.fy_px && a.cx_px == b.cx_px && a.cy_px == b.cy_px && a.k1 == b.k1 &&
         a.k2 == b.k2 && a.p1 == b.p1 && a.p2 == b.p2 && a.k3 == b.k3;
}

TEST(CalibrationJson, KeepsACalibratedCameraToTheBit) {
  const TemporaryFolder folder;
  CameraCalibration found{.camera = camera, .covariance = covariance<9>(), .rms_px = 0.1};
  write_json(folder / "camera.json", calibration_json(found));
  const CameraSetup setup = read_camera_calibration(folder / "camera.json");
  EXPECT_TRUE(same(setup.camera, camera));
  EXPECT_EQ(setup.covariance, found.covariance);
  EXPECT_FALSE(setup.sensor);
}

TEST(CalibrationJson, KeepsAPairThatIsNotRectified) {
  const TemporaryFolder folder;
  RigCalibration found{.rig = {camera, camera}};
  found.rig.right.fx_px = 810;
  found.rig.right_from_left = exp((Vector6() << 0.01, 0.05, 0, -0.1, 0.001, 0.002).finished());
  write_json(folder / "stereo.json", calibration_json(found, 0.3, 0.9));
  const StereoSetup setup = read_stereo_calibration(folder / "stereo.json");
  ASSERT_TRUE(setup.rectification);
  const StereoRig& rig = setup.rectification->rig;
  EXPECT_TRUE(same(rig.left, camera));
  EXPECT_TRUE(same(rig.right, found.rig.right));
  EXPECT_EQ(rig.right_from_left.matrix(), found.rig.right_from_left.matrix());
  EXPECT_EQ(setup.calibration.disparities_px,
            rectify(found.rig, 0.3, 0.9).calibration.disparities_px);
}

TEST(CalibrationJson, ReadsALaserLinePastItsUncertainty) {
  const TemporaryFolder folder;
  LaserLineSetup setup{{.camera = camera, .plane_normal = {0.6, 0, 0.8}, .plane_offset_m = 0.2},
                       {Pose::Identity()}};
  LightPlaneCalibration found;
  found.covariance = covariance<13>();
  write_json(folder / "laser.json", calibration_json(setup, found));
  const LaserLineSetup read = read_laser_line_calibration(folder / "laser.json");
  EXPECT_TRUE(same(read.calibration.camera, camera));
  EXPECT_EQ(read.calibration.plane_normal, setup.calibration.plane_normal);
}

// What only readers of the file see: each figure under its own name.
TEST(CalibrationJson, NamesEachFigureOfTheUncertainty) {
  const CameraCalibration one{.camera = camera, .rms_px = 1, .sigma_px = 2};
  const auto of_camera = calibration_json(one)["uncertainty"];
  EXPECT_EQ(of_camera["rms_px"], 1);
  EXPECT_EQ(of_camera["sigma_px"], 2);
  const RigCalibration rig{.rig = {camera, camera},
                           .baseline_sigma_m = 3,
                           .rms_px = 4,
                           .sigma_px = 5,
                           .epipolar_rms_px = 6};
  const auto of_rig = calibration_json(rig, 0.3, 0.9)["uncertainty"];
  EXPECT_EQ(of_rig["baseline_sigma_m"], 3);
  EXPECT_EQ(of_rig["rms_px"], 4);
  EXPECT_EQ(of_rig["sigma_px"], 5);
  EXPECT_EQ(of_rig["epipolar_rms_px"], 6);
  const LightPlaneCalibration plane{.rms_m = 7, .misfit = 8, .points = 9};
  const auto of_plane =
      calibration_json(LaserLineSetup{{.camera = camera}, {}}, plane)["uncertainty"];
  EXPECT_EQ(of_plane["rms_m"], 7);
  EXPECT_EQ(of_plane["misfit"], 8);
  EXPECT_EQ(of_plane["points"], 9);
}

TEST(CalibrationJson, NamesWhatIsWrongWithARigOrACovariance) {
  const TemporaryFolder folder;
  RigCalibration found{.rig = {camera, camera}};
  found.rig.right_from_left.translation() = Eigen::Vector3d(0.1, 0, 0);  // to the left
  write_json(folder / "stereo.json", calibration_json(found, 0.3, 0.9));
  EXPECT_NE(error_of([&] {
              read_stereo_calibration(folder / "stereo.json");
            }).find("stereo.json: stereo rig: the right camera stands at -0.1 m"),
            std::string::npos);
  auto json = calibration_json(CameraCalibration{.camera = camera});
  json["uncertainty"]["covariance"].erase(3);
  write_json(folder / "camera.json", json);
  EXPECT_NE(error_of([&] {
              read_camera_calibration(folder / "camera.json");
            }).find("camera.json/uncertainty/covariance: must be 9 rows of 9 numbers"),
            std::string::npos);
}

}  // namespace
}  // namespace scan
