// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Raw frames and calibrations on disk.
//
// calibration.json (each length with its unit in the key: _m, _mm or _um; times _s, _ms, _us, _ns):
//   every device  "device": "laser-line" | "stereo" | "phase" | "waveform"
//   camera        "camera": { width_px, height_px, fx_px, fy_px, cx_px, cy_px, [k1, k2, p1, p2, k3]
//   } sensor        "sensor": { gain_e_per_dn, [offset_dn, read_noise_e, full_well_e, bits] }
//   laser-line    camera, sensor, "light_plane": { "normal": [3], offset_mm }, [min_range_mm,
//                 max_range_mm], "scanner_from_camera": [4x4, ... one per image]
//   stereo        width_px, height_px, focal_px, cx_px, cy_px, [doffs_px], baseline_mm,
//                 [min_disparity_px], disparities_px; of a pair that is not rectified instead:
//                 "left": camera, "right": camera, "right_from_left": 4x4, nearest_mm, farthest_mm
//   phase         camera, sensor, frequencies_mhz: [...], [max_range_m]
//   waveform      sensor, sample_interval_ns, [window_start_ns], pulse_sigma_ns, [rows, columns],
//                 [range_walk_ns, range_walk_electrons], ["gated": true], ["moving": true]
//   any           ["uncertainty": what calibrating found, which decoding does not use]
// "device": "camera" holds a camera by itself, as `scan calibrate camera` writes it, and [sensor].
// Keys in brackets have the defaults of libscan/core/raw_frames.h.
//
// Files of a folder: 000.png, 001.png, ... (laser-line); left.png, right.png; frequency_0_tap_0.png
// to frequency_N_tap_3.png (phase); samples.npy (rays x samples), directions.npy (rays x 3),
// first_samples.npy (rays) if gated, poses.npy (rays x 12, the upper three rows of each
// scanner_from_ray) if moving.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "libscan/core/raw_frames.h"

namespace scan {

// The device kinds by the command line's words: "laser-line", "stereo", "phase", "waveform".
std::string_view kind_of(const RawFrames& frames);

// Writes calibration.json, images as 16-bit PNG (stereo: left.png, right.png), waveforms as npy,
// all into an existing folder.
void write_raw_frames(const std::filesystem::path& folder, const RawFrames& frames);

// Reads what write_raw_frames wrote, or a real device's files: `inputs` in order (laser-line: one
// image per step; stereo: left, right; phase: four taps per frequency; waveform: samples.npy,
// directions.npy and what else it has), or one folder that holds them under the names that
// write_raw_frames uses. `calibration` is JSON as above, or Middlebury's calib.txt for stereo
// (cam0, cam1, doffs, baseline in mm, width, height, ndisp). scan::Error (input) names file and
// field; pixels above the sensor's bits, images of another size than the camera's and wrong counts
// are refused.
RawFrames read_raw_frames(std::string_view kind, const std::vector<std::filesystem::path>& inputs,
                          const std::filesystem::path& calibration);

}  // namespace scan
