// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Calibrations of a camera and of the four devices as JSON (keys: raw_files.h) and as Middlebury's
// calib.txt.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "libscan/acquire/calibrate_light_plane.h"
#include "libscan/acquire/calibrate_stereo.h"
#include "libscan/core/raw_frames.h"

namespace scan {

// What calibration.json holds beside the calibration proper.
struct LaserLineSetup {
  LaserLineCalibration calibration;
  std::vector<Pose> scanner_from_camera;
};
struct StereoSetup {
  StereoCalibration calibration;
  std::optional<Rectification> rectification;  // pictures are as taken
};
struct CameraSetup {
  Camera camera;
  CameraCovariance covariance;   // zero if the file holds none
  std::optional<Sensor> sensor;  // which no picture of a board tells
};
struct WaveformSetup {
  WaveformCalibration calibration;
  RayGrid grid;
  bool is_gated = false;   // first_samples.npy says where each ray's record begins
  bool is_moving = false;  // poses.npy says where the scanner was at each ray
};

// scan::Error (input) names file and key; "device" must be the one asked for.
LaserLineSetup read_laser_line_calibration(const std::filesystem::path& path);
StereoSetup read_stereo_calibration(const std::filesystem::path& path);  // or calib.txt
PhaseCalibration read_phase_calibration(const std::filesystem::path& path);
WaveformSetup read_waveform_calibration(const std::filesystem::path& path);
CameraSetup read_camera_calibration(const std::filesystem::path& path);

nlohmann::ordered_json calibration_json(const StripeImages& frames);
nlohmann::ordered_json calibration_json(const ImagePair& frames);
nlohmann::ordered_json calibration_json(const PhaseTaps& frames);
nlohmann::ordered_json calibration_json(const Waveforms& frames);

// What calibrating a device found, with "uncertainty".
nlohmann::ordered_json calibration_json(const CameraCalibration& found);
nlohmann::ordered_json calibration_json(const LaserLineSetup& setup,
                                        const LightPlaneCalibration& found);
nlohmann::ordered_json calibration_json(const RigCalibration& found, double nearest_m,
                                        double farthest_m);

}  // namespace scan
