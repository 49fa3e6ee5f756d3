// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Raw data as a device delivers it, with the calibration that the device is sold with.
//
// synth renders these, real devices record them, and acquire decodes them; none can tell which.
// To add a device: 1. its struct and calibration here; 2. its name in the variant; 3. a decoder in
// libscan/acquire; 4. a renderer in synth/scanners; 5. its files in libscan/io/raw_frames.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include "libscan/core/camera.h"
#include "libscan/core/image.h"
#include "libscan/core/pose.h"
#include "libscan/core/scan.h"

namespace scan {

// How a pixel turns electrons into digital numbers (DN):
// dn = clamp(round(electrons / gain_e_per_dn + offset_dn), 0, 2^bits - 1).
struct Sensor {
  double gain_e_per_dn = 1;
  double offset_dn = 0;
  double read_noise_e = 0;   // 1 sigma
  double full_well_e = 1e9;  // electrons at which a pixel saturates
  int bits = 16;             // at most 16
};

// Laser triangulation: one image of the stripe per step of a stage or turntable.
struct LaserLineCalibration {
  Camera camera;
  Eigen::Vector3d plane_normal = Eigen::Vector3d::UnitX();  // unit, camera frame
  double plane_offset_m = 0;  // normal . x = offset on the light plane
  Sensor sensor;
  double min_range_m = 0;  // along camera z; peaks outside are no points
  double max_range_m = 1e9;
};

// The stripe runs roughly along image columns: one peak per image row and step. Ray index =
// step * height + row; grid rows are steps.
struct StripeImages {
  LaserLineCalibration calibration;
  std::vector<Image<std::uint16_t>> images;  // DN, one per step
  std::vector<Pose> scanner_from_camera;     // one per step, from the encoder
};

// Stereo: a rectified pair. A left pixel (column, row) is seen at (column - d, row) on the right,
// and Z = focal_px * baseline_m / (d + doffs_px) (Middlebury's convention). Scanner frame = left
// camera.
struct StereoCalibration {
  int width_px = 0;
  int height_px = 0;
  double focal_px = 0;
  double cx_px = 0;  // left image
  double cy_px = 0;
  double doffs_px = 0;  // cx of the right image minus cx of the left
  double baseline_m = 0;
  int min_disparity_px = 0;
  int disparities_px = 0;  // size of the search range
};

// Ray index = row * width + column of the left image.
struct ImagePair {
  StereoCalibration calibration;
  Image<std::uint8_t> left;
  Image<std::uint8_t> right;
};

// Phase camera (amplitude-modulated continuous wave): four taps per frequency,
// C_k = B + A cos(phi + k pi/2) electrons, phi = 4 pi f d / c, d the distance along the pixel's
// ray.
struct PhaseCalibration {
  Camera camera;
  std::vector<double> frequencies_hz;
  Sensor sensor;
  double max_range_m = 1e9;  // unwrapping looks no further
};

// Ray index = row * width + column.
struct PhaseTaps {
  PhaseCalibration calibration;
  std::vector<std::array<Image<std::uint16_t>, 4>> taps;  // DN, one set per frequency
};

// Pulsed lidar: the digitised echo of each pulse.
struct WaveformCalibration {
  double sample_interval_s = 1e-9;
  double window_start_s = 0;    // first sample, after the middle of the emitted pulse
  double pulse_sigma_s = 2e-9;  // standard deviation of the Gaussian pulse as received
  Sensor sensor;
  // Range walk: an echo of N electrons comes range_walk_s log10(N / range_walk_electrons) late.
  double range_walk_s = 0;
  double range_walk_electrons = 1000;
};

// Sample i of ray r stands at samples[r * samples_per_ray + i]; the ray's record begins
// first_sample[r] samples behind the window's start. Ray origin is the scanner's origin when the
// ray was fired.
struct Waveforms {
  WaveformCalibration calibration;
  RayGrid grid;
  std::vector<Eigen::Vector3d> directions;  // unit, frame of the scanner as it fired, one per ray
  std::uint32_t samples_per_ray = 0;
  std::vector<std::uint16_t> samples;       // DN
  std::vector<std::uint32_t> first_sample;  // empty: 0 for all
  std::vector<Pose> scanner_from_ray;  // scan frame from the scanner as it fired; empty: identity
};

using RawFrames = std::variant<StripeImages, ImagePair, PhaseTaps, Waveforms>;

}  // namespace scan
