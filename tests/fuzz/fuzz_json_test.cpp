// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Broken copies of calibrations and recipes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "libscan/io/calibration_json.h"
#include "libscan/io/json_output.h"
#include "tests/fuzz/fuzz.h"
#include "tools/recipe.h"

namespace scan::test {
namespace {

const Camera camera = {64, 48, 80.5, 80.25, 31.5, 23.5, -0.1, 0.02, 1e-4, 2e-5, 0};

// A nesting of JSON takes some hundred bytes a letter ("[[[[").
constexpr Allowance parsed{.fixed_bytes = std::size_t{1} << 22, .per_byte = 4096};

void expect_sound(const Camera& read) {
  check(read);
}

TEST(Fuzz, CalibrationOfALaserLine) {
  const TemporaryFolder folder;
  const LaserLineSetup setup{{.camera = camera, .plane_offset_m = 0.2},
                             {Pose::Identity(), Pose::Identity()}};
  write_json(folder / "laser.json", calibration_json(setup, LightPlaneCalibration{}));
  fuzz(
      folder / "laser.json",
      [](const auto& path) {
        const LaserLineSetup read = read_laser_line_calibration(path);
        expect_sound(read.calibration.camera);
        expect_finite("the light plane", read.calibration.plane_normal);
        for (const Pose& pose : read.scanner_from_camera) expect_finite("a pose", pose.matrix());
      },
      parsed);
}

TEST(Fuzz, CalibrationOfAStereoPair) {
  const TemporaryFolder folder;
  const Reader read = [](const auto& path) {
    const StereoCalibration c = read_stereo_calibration(path).calibration;
    expect_finite("the calibration", Eigen::Matrix<double, 5, 1>(c.focal_px, c.cx_px, c.cy_px,
                                                                 c.doffs_px, c.baseline_m));
    if (c.width_px <= 0 || c.height_px <= 0 || c.disparities_px <= 0 || !(c.focal_px > 0) ||
        !(c.baseline_m > 0))
      throw std::logic_error("a size is not positive");
  };
  RigCalibration rig{.rig = {camera, camera}};
  rig.rig.right_from_left.translation() = Eigen::Vector3d(-0.1, 0, 0);
  write_json(folder / "rig.json", calibration_json(rig, 0.5, 2));
  fuzz(folder / "rig.json", read, parsed);
  write_json(folder / "pair.json",
             calibration_json(ImagePair{{64, 48, 80, 31.5, 23.5, 0.5, 0.1, 0, 32}, {}, {}}));
  fuzz(folder / "pair.json", read, parsed);
  write_file(folder / "calib.txt",
             "cam0=[994.978 0 311.193; 0 994.978 254.877; 0 0 1]\n"
             "cam1=[994.978 0 342.279; 0 994.978 254.877; 0 0 1]\ndoffs=31.086\n"
             "baseline=193.001\nwidth=741\nheight=497\nndisp=64\n");
  fuzz(folder / "calib.txt", read);
}

TEST(Fuzz, CalibrationsOfOtherDevices) {
  const TemporaryFolder folder;
  write_json(folder / "camera.json", calibration_json(CameraCalibration{.camera = camera}));
  fuzz(
      folder / "camera.json",
      [](const auto& path) {
        const CameraSetup read = read_camera_calibration(path);
        expect_sound(read.camera);
        expect_finite("the covariance", read.covariance);
      },
      parsed);
  write_json(folder / "phase.json", calibration_json(PhaseTaps{{camera, {20e6, 80e6}, {}, 7}, {}}));
  fuzz(
      folder / "phase.json",
      [](const auto& path) { expect_sound(read_phase_calibration(path).camera); }, parsed);
  write_json(folder / "waveform.json", calibration_json(Waveforms{}));
  fuzz(
      folder / "waveform.json",
      [](const auto& path) {
        const WaveformCalibration read = read_waveform_calibration(path).calibration;
        if (!(read.sample_interval_s > 0) || !(read.pulse_sigma_s > 0))
          throw std::logic_error("a time is not positive");
      },
      parsed);
}

// Recipes as shipped; a copy that is read must be written again, as a run does.
TEST(Fuzz, Recipes) {
  const TemporaryFolder folder;
  for (const char* name : {"bracket-laser", "vessel-phase", "pavilion-lidar", "bud-stereo"}) {
    const std::filesystem::path shipped =
        std::filesystem::path(LIBSCAN_SOURCE_DIR) / "datasets" / "recipes" / name;
    const std::string text = read_file(shipped.string() + ".json");
    const auto path = folder / (std::string(name) + ".json");
    write_file(path, text);
    fuzz(path, [](const auto& file) { (void)to_json(read_recipe(file)).dump(); },
         {.fixed_bytes = std::size_t{1} << 24, .per_byte = 4096});
  }
}

}  // namespace
}  // namespace scan::test
