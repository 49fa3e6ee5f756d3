// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/raw_files.h"

#include <gtest/gtest.h>

#include "libscan/io/image_file.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

const Camera camera = {6, 4, 100.1, 99.7, 2.5, 1.5, 0.01, -0.002, 1e-4, 2e-5, 3e-6};
const Sensor sensor = {1.7, 64.3, 2.5, 30000.5, 12};

Image<std::uint16_t> frame(std::uint64_t which) {
  Image<std::uint16_t> image(camera.width_px, camera.height_px);
  RandomStream random(12, 0, which);
  for (auto& pixel : image.pixels) pixel = static_cast<std::uint16_t>(random.bits32() & 4095);
  return image;
}

Pose pose(double turn) {
  Vector6 twist;
  twist << 0, turn, 0.1, 0.01 * turn, 0, 1.0 / 3;
  return exp(twist);
}

StripeImages stripes() {
  StripeImages frames;
  frames.calibration = {
      camera, Eigen::Vector3d(1, 0.1, -0.3).normalized(), 0.123456789012345678, sensor, 0.1, 0.9};
  for (int i = 0; i < 3; ++i) {
    frames.images.push_back(frame(static_cast<std::uint64_t>(i)));
    frames.scanner_from_camera.push_back(pose(0.1 * i));
  }
  return frames;
}

ImagePair pair() {
  ImagePair frames;
  frames.calibration = {6, 4, 994.978, 2.5, 1.5, 31.086, 0.193001, -2, 64};
  frames.left = Image<std::uint8_t>(6, 4, 7);
  frames.right = Image<std::uint8_t>(6, 4, 9);
  frames.right(5, 3) = 200;
  return frames;
}

PhaseTaps taps() {
  PhaseTaps frames;
  frames.calibration = {camera, {20e6, 80.1e6}, sensor, 7.5};
  for (std::uint64_t f = 0; f < 2; ++f)
    frames.taps.push_back({frame(4 * f), frame(4 * f + 1), frame(4 * f + 2), frame(4 * f + 3)});
  return frames;
}

Waveforms waveforms() {
  Waveforms frames;
  frames.calibration = {0.5e-9, 3e-9, 2.1e-9, sensor};
  frames.grid = {2, 3};
  frames.samples_per_ray = 5;
  RandomStream random(13, 0, 0);
  for (int i = 0; i < 6; ++i)
    frames.directions.push_back(Eigen::Vector3d(random.normal(), random.normal(), 1).normalized());
  for (int i = 0; i < 30; ++i)
    frames.samples.push_back(static_cast<std::uint16_t>(random.bits32() & 4095));
  return frames;
}

void expect_same(const Camera& a, const Camera& b) {
  EXPECT_EQ(std::tie(a.width_px, a.height_px, a.fx_px, a.fy_px, a.cx_px, a.cy_px),
            std::tie(b.width_px, b.height_px, b.fx_px, b.fy_px, b.cx_px, b.cy_px));
  EXPECT_EQ(std::tie(a.k1, a.k2, a.p1, a.p2, a.k3), std::tie(b.k1, b.k2, b.p1, b.p2, b.k3));
}

void expect_same(const Sensor& a, const Sensor& b) {
  EXPECT_EQ(std::tie(a.gain_e_per_dn, a.offset_dn, a.read_noise_e, a.full_well_e, a.bits),
            std::tie(b.gain_e_per_dn, b.offset_dn, b.read_noise_e, b.full_well_e, b.bits));
}

template <class Frames>
Frames round_trip(const TemporaryFolder& folder, const Frames& frames) {
  const RawFrames raw = frames;
  write_raw_frames(folder.path(), raw);
  const RawFrames back =
      read_raw_frames(kind_of(raw), {folder.path()}, folder / "calibration.json");
  return std::get<Frames>(back);
}

TEST(RawFiles, StripesComeBackToTheBit) {
  const TemporaryFolder folder;
  const StripeImages a = stripes(), b = round_trip(folder, a);
  expect_same(a.calibration.camera, b.calibration.camera);
  expect_same(a.calibration.sensor, b.calibration.sensor);
  EXPECT_EQ(a.calibration.plane_normal, b.calibration.plane_normal);
  EXPECT_EQ(a.calibration.plane_offset_m, b.calibration.plane_offset_m);
  EXPECT_EQ(a.calibration.min_range_m, b.calibration.min_range_m);
  EXPECT_EQ(a.calibration.max_range_m, b.calibration.max_range_m);
  ASSERT_EQ(b.images.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(a.images[i].pixels, b.images[i].pixels);
    EXPECT_EQ(a.scanner_from_camera[i].matrix(), b.scanner_from_camera[i].matrix());
  }
}

TEST(RawFiles, PairsComeBackToTheBit) {
  const TemporaryFolder folder;
  const ImagePair a = pair(), b = round_trip(folder, a);
  EXPECT_EQ(a.left.pixels, b.left.pixels);
  EXPECT_EQ(a.right.pixels, b.right.pixels);
  const StereoCalibration &x = a.calibration, &y = b.calibration;
  EXPECT_EQ(
      std::tie(x.width_px, x.height_px, x.focal_px, x.cx_px, x.cy_px, x.doffs_px, x.baseline_m),
      std::tie(y.width_px, y.height_px, y.focal_px, y.cx_px, y.cy_px, y.doffs_px, y.baseline_m));
  EXPECT_EQ(std::tie(x.min_disparity_px, x.disparities_px),
            std::tie(y.min_disparity_px, y.disparities_px));
}

TEST(RawFiles, TapsComeBackToTheBit) {
  const TemporaryFolder folder;
  const PhaseTaps a = taps(), b = round_trip(folder, a);
  expect_same(a.calibration.camera, b.calibration.camera);
  expect_same(a.calibration.sensor, b.calibration.sensor);
  EXPECT_EQ(a.calibration.frequencies_hz, b.calibration.frequencies_hz);
  EXPECT_EQ(a.calibration.max_range_m, b.calibration.max_range_m);
  ASSERT_EQ(b.taps.size(), 2u);
  for (std::size_t f = 0; f < 2; ++f)
    for (std::size_t tap = 0; tap < 4; ++tap)
      EXPECT_EQ(a.taps[f][tap].pixels, b.taps[f][tap].pixels);
}

TEST(RawFiles, WaveformsComeBackToTheBit) {
  const TemporaryFolder folder;
  const Waveforms a = waveforms(), b = round_trip(folder, a);
  expect_same(a.calibration.sensor, b.calibration.sensor);
  EXPECT_EQ(std::tie(a.calibration.sample_interval_s, a.calibration.window_start_s,
                     a.calibration.pulse_sigma_s),
            std::tie(b.calibration.sample_interval_s, b.calibration.window_start_s,
                     b.calibration.pulse_sigma_s));
  EXPECT_EQ(a.grid.rows, b.grid.rows);
  EXPECT_EQ(a.grid.columns, b.grid.columns);
  EXPECT_EQ(a.directions, b.directions);
  EXPECT_EQ(a.samples_per_ray, b.samples_per_ray);
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_TRUE(b.first_sample.empty());
  EXPECT_TRUE(b.scanner_from_ray.empty());
}

TEST(RawFiles, GatedWaveformsOfAMovingScannerComeBackToTheBit) {
  const TemporaryFolder folder;
  Waveforms a = waveforms();
  a.calibration.range_walk_s = -3e-10;
  a.calibration.range_walk_electrons = 250;
  for (int i = 0; i < 6; ++i) {
    a.first_sample.push_back(17 * i);
    a.scanner_from_ray.push_back(exp((Vector6() << 0.1 * i, 0.2, -0.3, 1, i, 3).finished()));
  }
  const Waveforms b = round_trip(folder, a);
  EXPECT_EQ(a.calibration.range_walk_s, b.calibration.range_walk_s);
  EXPECT_EQ(a.calibration.range_walk_electrons, b.calibration.range_walk_electrons);
  EXPECT_EQ(a.first_sample, b.first_sample);
  ASSERT_EQ(b.scanner_from_ray.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(a.scanner_from_ray[i].matrix(), b.scanner_from_ray[i].matrix());
  const auto said = [&] {
    return error_of(
        [&] { read_raw_frames("waveform", {folder.path()}, folder / "calibration.json"); });
  };
  write_npy(folder / "poses.npy", {6, 12}, std::vector<double>(72, 1.0));
  EXPECT_NE(said().find("pose 0 is no rigid motion"), std::string::npos);
  write_npy(folder / "first_samples.npy", {2}, std::vector<double>{1, 2});
  EXPECT_NE(said().find("has 2 rays"), std::string::npos);
}

TEST(RawFiles, MiddleburyCalibrationFollowsItsConvention) {
  const TemporaryFolder folder;
  write_raw_frames(folder.path(), pair());
  write_file(folder / "calib.txt",
             "cam0=[994.978 0 311.193; 0 994.978 254.877; 0 0 1]\r\n"
             "cam1=[994.978 0 342.279; 0 994.978 254.877; 0 0 1]\r\n"
             "doffs=31.086\nbaseline=193.001\nwidth=6\nheight=4\nndisp=64\nisint=0\nvmin=7\n");
  const auto raw =
      read_raw_frames("stereo", {folder / "left.png", folder / "right.png"}, folder / "calib.txt");
  const StereoCalibration& calibration = std::get<ImagePair>(raw).calibration;
  EXPECT_EQ(calibration.focal_px, 994.978);
  EXPECT_EQ(calibration.cx_px, 311.193);
  EXPECT_EQ(calibration.cy_px, 254.877);
  EXPECT_EQ(calibration.doffs_px, 31.086);
  EXPECT_EQ(calibration.baseline_m, 193.001 * 1e-3);
  EXPECT_EQ(calibration.disparities_px, 64);
  write_file(folder / "short.txt", "cam0=[1 0 2; 0 1 2; 0 0 1]\n");
  EXPECT_NE(error_of([&] {
              read_raw_frames("stereo", {folder.path()}, folder / "short.txt");
            }).find("cam1: is missing"),
            std::string::npos);
}

TEST(RawFiles, NameFileAndKeyOfWhatIsBroken) {
  const TemporaryFolder folder;
  write_raw_frames(folder.path(), stripes());
  const std::string good = read_file(folder / "calibration.json");
  const auto said = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    write_file(folder / "c.json", text);
    return error_of([&] { read_raw_frames("laser-line", {folder.path()}, folder / "c.json"); });
  };
  EXPECT_NE(said("\"laser-line\"", "\"phase\"").find("/device: is 'phase', must be 'laser-line'"),
            std::string::npos);
  EXPECT_NE(
      said("\"fx_px\": 100.1", "\"fx_px\": -1").find("/camera/fx_px: is -1, must be positive"),
      std::string::npos);
  EXPECT_NE(said("\"bits\": 12", "\"bits\": 17").find("/sensor/bits: is 17, must be 1 to 16"),
            std::string::npos);
  EXPECT_NE(said("\"bits\": 12", "\"bits\": 4").find("a sensor of 4 bits ends at 15"),
            std::string::npos);
  EXPECT_NE(said("\"k1\"", "\"k9\"").find("/camera/k9: unknown key"), std::string::npos);
  EXPECT_NE(
      said("\"width_px\": 6", "\"width_px\": 7").find("is 6 x 4 px, the calibration says 7 x 4"),
      std::string::npos);
  std::filesystem::remove(folder / "002.png");
  EXPECT_NE(error_of([&] {
              read_raw_frames("laser-line", {folder.path()}, folder / "calibration.json");
            }).find("002.png: no such file"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              read_raw_frames("laser-line", {folder / "000.png", folder / "001.png"},
                              folder / "calibration.json");
            }).find("2 files are given, the calibration needs 3"),
            std::string::npos);
  error_of([&] { read_raw_frames("sonar", {}, folder / "calibration.json"); }, Trouble::usage);
}

TEST(RawFiles, RefuseWaveformsThatDoNotBelongTogether) {
  const TemporaryFolder folder;
  write_raw_frames(folder.path(), waveforms());
  const auto said = [&] {
    return error_of(
        [&] { read_raw_frames("waveform", {folder.path()}, folder / "calibration.json"); });
  };
  write_npy(folder / "directions.npy", {2, 3}, std::vector<double>{0, 0, 1, 0, 1, 0});
  EXPECT_NE(said().find("has 6 rays"), std::string::npos);
  write_npy(folder / "directions.npy", {2, 3}, std::vector<double>{0, 0, 1, 0, 1.1, 0});
  EXPECT_NE(said().find("direction 1 has length 1.1"), std::string::npos);
  write_npy(folder / "samples.npy", {1, 2}, std::vector<double>{1, 1.5});
  EXPECT_NE(said().find("holds 1.5"), std::string::npos);
}

TEST(RealData, TheMotorcyclePairReads) {
  const auto data = outside_data() / "middlebury-motorcycle";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "the stereo pair is not in " << data;
  const TemporaryFolder folder;
  write_file(folder / "calib.txt",
             "cam0=[994.978 0 311.193; 0 994.978 254.877; 0 0 1]\ncam1=[994.978 0 342.279; 0 "
             "994.978 254.877; 0 0 1]\n"
             "doffs=31.086\nbaseline=193.001\nwidth=741\nheight=500\nndisp=70\n");
  const auto raw =
      read_raw_frames("stereo", {data / "motorcycle_left.png", data / "motorcycle_right.png"},
                      folder / "calib.txt");
  EXPECT_EQ(std::get<ImagePair>(raw).left.pixels.size(), 741u * 500u);
}

}  // namespace
}  // namespace scan
