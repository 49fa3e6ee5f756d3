// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/calibration_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/json_reader.h"
#include "libscan/io/middlebury.h"
#include "libscan/io/shape_json.h"
#include "libscan/io/text.h"

namespace scan {
namespace {

int whole(JsonReader& reader, std::string_view key, long low, long high,
          const long* otherwise = nullptr) {
  const long number = otherwise ? reader.integer(key, *otherwise) : reader.integer(key);
  if (number < low || number > high)
    reader.fail(key, "is " + std::to_string(number) + ", must be " + std::to_string(low) + " to " +
                         std::to_string(high));
  return static_cast<int>(number);
}

double positive(JsonReader& reader, const char* key, double number) {
  if (!(number > 0)) reader.fail(key, "is " + shortest(number) + ", must be positive");
  return number;
}

double not_negative(JsonReader& reader, const char* key, double number) {
  if (!(number >= 0)) reader.fail(key, "is " + shortest(number) + ", must not be negative");
  return number;
}

Camera read_camera(JsonReader reader) {
  constexpr long largest_side = 1 << 20;
  Camera camera;
  camera.width_px = whole(reader, "width_px", 1, largest_side);
  camera.height_px = whole(reader, "height_px", 1, largest_side);
  camera.fx_px = positive(reader, "fx_px", reader.number("fx_px"));
  camera.fy_px = positive(reader, "fy_px", reader.number("fy_px"));
  camera.cx_px = reader.number("cx_px");
  camera.cy_px = reader.number("cy_px");
  camera.k1 = reader.number("k1", camera.k1);
  camera.k2 = reader.number("k2", camera.k2);
  camera.p1 = reader.number("p1", camera.p1);
  camera.p2 = reader.number("p2", camera.p2);
  camera.k3 = reader.number("k3", camera.k3);
  reader.finish();
  return camera;
}

Sensor read_sensor(JsonReader reader) {
  Sensor sensor;
  sensor.gain_e_per_dn = positive(reader, "gain_e_per_dn", reader.number("gain_e_per_dn"));
  sensor.offset_dn = reader.number("offset_dn", sensor.offset_dn);
  sensor.read_noise_e =
      not_negative(reader, "read_noise_e", reader.number("read_noise_e", sensor.read_noise_e));
  sensor.full_well_e =
      positive(reader, "full_well_e", reader.number("full_well_e", sensor.full_well_e));
  const long bits = sensor.bits;
  sensor.bits = whole(reader, "bits", 1, 16, &bits);
  reader.finish();
  return sensor;
}

// The covariance of a camera; its figures are for readers of the file.
CameraCovariance read_uncertainty(JsonReader reader) {
  for (const char* figure : {"rms_px", "sigma_px"})
    not_negative(reader, figure, reader.number(figure));
  const nlohmann::json& rows = reader.value("covariance");
  CameraCovariance covariance;
  const auto is_row = [](const nlohmann::json& row) {
    return row.is_array() && row.size() == 9 &&
           std::all_of(row.begin(), row.end(), [](const auto& x) { return x.is_number(); });
  };
  if (!rows.is_array() || rows.size() != 9 || !std::all_of(rows.begin(), rows.end(), is_row))
    reader.fail("covariance", "must be 9 rows of 9 numbers");
  for (int i = 0; i < 81; ++i) covariance(i / 9, i % 9) = rows[i / 9][i % 9].get<double>();
  if (!(covariance.diagonal().minCoeff() >= 0))
    reader.fail("covariance", "must not have a negative diagonal");
  reader.finish();
  return covariance;
}

void read_light_plane(JsonReader reader, LaserLineCalibration& calibration) {
  const auto normal = reader.numbers("normal");
  if (normal.size() != 3) reader.fail("normal", "must have three numbers");
  calibration.plane_normal = {normal[0], normal[1], normal[2]};
  // what is written with six digits is a unit vector still; what libscan wrote is kept to the bit
  const double length = calibration.plane_normal.norm();
  if (!(std::abs(length - 1) < 1e-5))
    reader.fail("normal", "has length " + shortest(length) + ", must be 1");
  if (std::abs(length - 1) > 1e-12) calibration.plane_normal /= length;
  calibration.plane_offset_m = reader.length_m("offset");
  reader.finish();
}

std::vector<Pose> read_steps(JsonReader& reader) {
  const nlohmann::json& list = reader.value("scanner_from_camera");
  if (!list.is_array() || list.empty())
    reader.fail("scanner_from_camera", "must be a list of 4x4 matrices, one per image");
  std::vector<Pose> poses;
  for (const nlohmann::json& matrix : list)
    poses.push_back(pose_from_json(
        matrix, reader.place() + "/scanner_from_camera/" + std::to_string(poses.size())));
  return poses;
}

// A pair as it is taken; disparities as far as those of rectified pairs.
StereoSetup read_rig(JsonReader& reader) {
  StereoRig rig{read_camera(reader.object("left")), read_camera(reader.object("right"))};
  rig.right_from_left =
      pose_from_json(reader.value("right_from_left"), reader.place() + "/right_from_left");
  const double nearest_m = reader.length_m("nearest"), farthest_m = reader.length_m("farthest");
  try {
    const Rectification turned = rectify(rig, nearest_m, farthest_m);
    return {turned.calibration, turned};
  } catch (const Error& error) {
    throw Error(Trouble::input, reader.place() + ": " + error.what());
  }
}

// Opens a calibration of one kind of device, hands it to `read` and refuses what that left over.
template <class Read>
auto read_calibration(const std::filesystem::path& path, const std::string& device, Read read) {
  const nlohmann::json document = read_json(path);
  JsonReader reader(document, path.string());
  if (const std::string given = reader.text("device"); given != device)
    reader.fail("device", "is '" + given + "', must be '" + device + "'");
  if (device != "camera") reader.has("uncertainty");  // for readers of the file, not for decoding
  auto calibration = read(reader);
  reader.finish();
  return calibration;
}

}  // namespace

LaserLineSetup read_laser_line_calibration(const std::filesystem::path& path) {
  return read_calibration(path, "laser-line", [](JsonReader& reader) {
    LaserLineSetup setup;
    LaserLineCalibration& calibration = setup.calibration;
    calibration.camera = read_camera(reader.object("camera"));
    calibration.sensor = read_sensor(reader.object("sensor"));
    read_light_plane(reader.object("light_plane"), calibration);
    calibration.min_range_m = reader.length_m("min_range", calibration.min_range_m);
    calibration.max_range_m = reader.length_m("max_range", calibration.max_range_m);
    setup.scanner_from_camera = read_steps(reader);
    return setup;
  });
}

StereoSetup read_stereo_calibration(const std::filesystem::path& path) {
  if (lower_case(path.extension().string()) == ".txt")
    return {read_middlebury_calibration(path), {}};
  return read_calibration(path, "stereo", [](JsonReader& reader) {
    if (reader.has("left")) return read_rig(reader);
    constexpr long largest = 1 << 20, zero = 0;
    StereoCalibration calibration;
    calibration.width_px = whole(reader, "width_px", 1, largest);
    calibration.height_px = whole(reader, "height_px", 1, largest);
    calibration.focal_px = positive(reader, "focal_px", reader.number("focal_px"));
    calibration.cx_px = reader.number("cx_px");
    calibration.cy_px = reader.number("cy_px");
    calibration.doffs_px = reader.number("doffs_px", calibration.doffs_px);
    calibration.baseline_m = positive(reader, "baseline", reader.length_m("baseline"));
    calibration.min_disparity_px = whole(reader, "min_disparity_px", -largest, largest, &zero);
    calibration.disparities_px = whole(reader, "disparities_px", 1, largest);
    return StereoSetup{calibration, {}};
  });
}

PhaseCalibration read_phase_calibration(const std::filesystem::path& path) {
  return read_calibration(path, "phase", [](JsonReader& reader) {
    PhaseCalibration calibration;
    calibration.camera = read_camera(reader.object("camera"));
    calibration.sensor = read_sensor(reader.object("sensor"));
    calibration.frequencies_hz = reader.frequencies_hz("frequencies");
    if (calibration.frequencies_hz.empty()) reader.fail("frequencies", "is empty");
    for (const double frequency : calibration.frequencies_hz)
      positive(reader, "frequencies", frequency);
    calibration.max_range_m =
        positive(reader, "max_range", reader.length_m("max_range", calibration.max_range_m));
    return calibration;
  });
}

WaveformSetup read_waveform_calibration(const std::filesystem::path& path) {
  return read_calibration(path, "waveform", [](JsonReader& reader) {
    constexpr long largest = 1 << 30, zero = 0;
    WaveformSetup setup;
    WaveformCalibration& calibration = setup.calibration;
    calibration.sensor = read_sensor(reader.object("sensor"));
    calibration.sample_interval_s =
        positive(reader, "sample_interval", reader.time_s("sample_interval"));
    calibration.window_start_s = reader.time_s("window_start", calibration.window_start_s);
    calibration.pulse_sigma_s = positive(reader, "pulse_sigma", reader.time_s("pulse_sigma"));
    calibration.range_walk_s = reader.time_s("range_walk", calibration.range_walk_s);
    calibration.range_walk_electrons =
        positive(reader, "range_walk_electrons",
                 reader.number("range_walk_electrons", calibration.range_walk_electrons));
    setup.is_gated = reader.boolean("gated", false);
    setup.is_moving = reader.boolean("moving", false);
    setup.grid.rows = static_cast<std::uint32_t>(whole(reader, "rows", 0, largest, &zero));
    setup.grid.columns = static_cast<std::uint32_t>(whole(reader, "columns", 0, largest, &zero));
    return setup;
  });
}

CameraSetup read_camera_calibration(const std::filesystem::path& path) {
  return read_calibration(path, "camera", [](JsonReader& reader) {
    CameraSetup setup{read_camera(reader.object("camera")), CameraCovariance::Zero(), {}};
    if (reader.has("sensor")) setup.sensor = read_sensor(reader.object("sensor"));
    if (reader.has("uncertainty"))
      setup.covariance = read_uncertainty(reader.object("uncertainty"));
    return setup;
  });
}

}  // namespace scan
